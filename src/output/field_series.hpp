/// What series of points and series of lines have in common: data sets laid out once, steps that add values,
/// and an XDMF file that lists complete steps.
///
/// All of an HDF5 file is laid out when it is made, and its structure reaches the disk then: a step adds
/// values and nothing else, so whenever and however the program dies, all earlier steps can be read. A step
/// that was never written takes no disk space. The XDMF file lists a step once the first rank has it
/// on the disk, and is replaced in one step.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/field_view.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::output {

class Hdf5File;

enum class Precision { single_precision, double_precision };

/// What is to be stored, and where.
struct SeriesPlan {
  std::filesystem::path directory;
  std::string basename = "";  ///< of the .h5 and the .xdmf; empty: as the kind of series is usually called
  std::string title;
  std::string version;            ///< of the program
  std::vector<FieldInfo> fields;  ///< besides positions, which are always stored
  std::vector<long> steps;        ///< that will be written
  Precision precision = Precision::single_precision;
};

/// A field as the file knows it.
struct StoredField {
  std::string name, unit;
  int components = 1;
  Centring centring = Centring::point;
};

/// A data set that is written once, not at every step.
struct FixedDataset {
  enum class Type { real, integer };
  std::string name;       ///< with a slash
  std::string unit = "";  ///< no attribute if empty
  Type type = Type::real;
  int components = 1;
  Centring centring = Centring::point;
};

/// How points and cells are numbered and divided among ranks.
struct SeriesLayout {
  PointLayout points, cells;
  const PointLayout& of(Centring centring) const { return centring == Centring::point ? points : cells; }
};

/// Every call is collective and, if it fails on any rank (disk full), throws RunError on all; what was
/// written before stays readable.
class FieldSeries {
 public:
  /// `fields`: written at every step to /<field>/<step>, which has the attribute `unit` on /<field>.
  FieldSeries(const SeriesPlan& plan, const SeriesLayout& layout, std::vector<StoredField> fields,
              std::vector<FixedDataset> fixed, parallel::Communicator communicator);
  ~FieldSeries();

  /// Stores one of the fixed data sets: values as borrowed, or integers as they lie in memory.
  void write_fixed(const std::string& name, const FieldView& values);
  void write_fixed(const std::string& name, const std::vector<std::int64_t>& values);

  /// Stores the fields of a moment, each by `view_of`, and lists it in the XDMF file as the grid that
  /// `grid_of` writes when told the place of the step's data sets. Does not wait for the disk but after the
  /// last step of the plan, or one that is not in it; a failure there is thrown by the next call.
  void write(long step, const std::function<FieldView(const StoredField&)>& view_of,
             const std::function<std::string(const std::string& place)>& grid_of);

  /// Waits until the step that was written last is on the disk; one that cannot get there is listed no
  /// longer.
  void finish();

  const std::vector<StoredField>& fields() const { return fields_; }

  /// XDMF text: a reference to a data set of reals, integers; attributes of all fields but `without`; numbers
  /// of the moment.
  std::string xdmf_reals(const std::string& dataset, int components, Centring centring) const;
  std::string xdmf_integers(const std::string& dataset, int components, Centring centring) const;
  std::string xdmf_attributes(const std::string& place, const std::string& without) const;
  static std::string xdmf_annotations(const std::vector<Annotation>& annotations);

 private:
  struct ListedStep {
    std::string place, grid;  ///< name of its data sets; its XDMF text
  };

  void lay_out(Hdf5File& file, const SeriesPlan& plan, const std::vector<FixedDataset>& fixed) const;
  const void* packed(const FieldView& view, int components, Centring centring);
  void write_values(const std::string& dataset, int components, Centring centring,
                    const std::function<FieldView()>& view);
  void reserve(const std::vector<std::string>& datasets);
  std::string xdmf() const;
  void write_xdmf() const;

  SeriesLayout layout_;
  std::vector<StoredField> fields_;
  std::map<std::string, FixedDataset> fixed_;
  Precision precision_;
  std::string basename_;
  std::filesystem::path xdmf_path_;
  std::string hdf5_name_;
  parallel::Communicator communicator_;
  std::unique_ptr<Hdf5File> file_;
  std::map<long, std::string> planned_places_;
  std::vector<ListedStep> listed_;  ///< complete steps, in the order of writing
  std::vector<float> singles_;      ///< values on their way to the file, in the one precision
  std::vector<double> doubles_;     ///< or the other
  std::future<void> saving_;        ///< the step that was written last, to disk and into the XDMF file
};

/// The plan with a name for its files where it has none.
SeriesPlan named(SeriesPlan plan, const std::string& basename);

/// Where a step's values of a field lie: /<field>/<place>.
std::string dataset_name(const std::string& field, const std::string& place);

}  // namespace rhexis::output
