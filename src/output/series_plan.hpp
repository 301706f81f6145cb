// SPDX-License-Identifier: BSD-3-Clause
/// What there is to tell of a series, before any file is open.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/field_view.hpp"
#include "core/precision.hpp"

namespace rhexis::output {

enum class SeriesFormat {
  xdmf,    ///< NAME.h5 and .xdmf, see XdmfSeries
  vtkhdf,  ///< NAME.vtkhdf, see VtkHdfSeries
};

/// What is to be stored, and where.
struct SeriesPlan {
  std::filesystem::path directory;
  std::string basename = "";  ///< base name of the files; empty: as the kind of series is usually called
  std::string title;
  std::string version;                        ///< version of the program
  std::vector<FieldInfo> fields;              ///< besides positions, which are always stored
  std::vector<std::string> annotations = {};  ///< names of the numbers that go with every moment
  std::vector<long> steps;                    ///< that will be written
  Precision precision = Precision::single_precision;
  std::vector<SeriesFormat> formats = {SeriesFormat::xdmf};
};

/// A field as the file knows it.
struct StoredField {
  std::string name, unit;
  int components = 1;
  Centring centring = Centring::point;
};

/// Points with a cell at each, which move; or points that stay with lines between them, a cell each.
enum class SeriesKind { points, lines };

/// The field of points that move which holds where they are.
inline constexpr const char* position_field = "position";

/// When a step is, and numbers that go with it.
struct SeriesStep {
  long step = 0;
  double time_s = 0;
  std::vector<Annotation> annotations;
};

/// The moment of a PointSource or a LineSource.
template <class Source>
SeriesStep series_step(const Source& source) {
  return {source.step(), source.time_s(), source.annotations()};
}

/// How points and cells are numbered and divided among ranks.
struct SeriesLayout {
  IdRanges points, cells;
  const IdRanges& of(Centring centring) const { return centring == Centring::point ? points : cells; }
};

/// The plan with a name for its files where it has none.
SeriesPlan named(SeriesPlan plan, const std::string& basename);

/// The names of the files of a series.
std::vector<std::string> series_files(const std::string& basename, const std::vector<SeriesFormat>& formats);

std::vector<StoredField> stored(const std::vector<FieldInfo>& fields);

}  // namespace rhexis::output
