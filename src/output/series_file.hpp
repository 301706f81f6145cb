// SPDX-License-Identifier: BSD-3-Clause
/// The HDF5 file of a series: data sets of reals and integers, laid out once by the root, to which all ranks
/// then write their parts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/field_view.hpp"
#include "output/file_identity.hpp"
#include "output/hdf5_file.hpp"
#include "output/series_plan.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::output {

/// Where values of all N points, or cells, lie: rows [first_row, first_row + N) of a data set.
struct Place {
  std::string dataset;  ///< with its path
  int components = 1;
  Centring centring = Centring::point;
  std::int64_t rows = 0;  ///< rows of the data set; 0: N
  std::int64_t first_row = 0;
  bool flat = false;  ///< components one after another, in a data set of one dimension
};

/// Every call is collective, but for those that lay out and those that only tell. A failure on any rank (disk
/// full) is RunError on all.
class SeriesFile {
 public:
  SeriesFile(std::filesystem::path path, Precision precision, const SeriesLayout& layout,
             parallel::Communicator communicator);

  /// Makes the file with at most `datasets` data sets by `lay_out`, on the root alone, brings them to the
  /// disk, and opens the file on all ranks. It has its name only then; before, `finish` may change what HDF5
  /// has written. First of all calls.
  void create(
      std::size_t datasets, const std::function<void(Hdf5File&)>& lay_out,
      const std::function<void(const std::filesystem::path&)>& finish = [](const auto&) {});

  /// Within `lay_out`: a data set of reals, or of another type.
  void lay_out_reals(Hdf5File& file, const Place& place) const;
  void lay_out(Hdf5File& file, const Place& place, hid_t type) const;

  /// Has disk space for the values at these places, or throws.
  void reserve(const std::vector<Place>& places);
  void write(const Place& place, const std::function<FieldView()>& view);
  void write(const Place& place, const std::vector<std::int64_t>& values);

  const std::filesystem::path& path() const { return path_; }
  const SeriesLayout& layout() const { return layout_; }
  const parallel::Communicator& communicator() const { return communicator_; }
  int bytes_of_real() const { return precision_ == Precision::single_precision ? 4 : 8; }
  /// Where a data set begins in the file. On every rank alike.
  std::int64_t offset_of(const std::string& dataset) const { return file_->bytes_of(dataset).offset; }

 private:
  Slab slab_of(const Place& place) const;
  const void* packed(const FieldView& view, const Place& place);

  std::filesystem::path path_;
  Precision precision_;
  SeriesLayout layout_;
  parallel::Communicator communicator_;
  std::unique_ptr<Hdf5File> file_;
  std::optional<FileIdentity> identity_;  ///< known to the root: somebody may take the file away
  std::vector<float> singles_;            ///< values on their way to the file, in the one precision
  std::vector<double> doubles_;           ///< or the other
};

/// The global numbers of this rank's points or cells, in the order of its values.
std::vector<std::int64_t> numbers_of(const IdRanges& ids);

}  // namespace rhexis::output
