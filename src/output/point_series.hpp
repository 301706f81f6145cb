/// A body's fields over time: one parallel HDF5 file, and an XDMF file that tells ParaView what is in it.
///
/// `particles.h5` holds, in the partition-independent order id = column * rows + row:
///   /<field>/<step>       [N] or [N, 3], the step in six digits, e.g. /displacement/000050; attribute `unit`
///   on /<field> /position/<step>      [N, 3], deformed
///   /<field>/unplanned    as a step; used when a run ends early at a step that was not planned.
///   `particles.xdmf`
///                         tells which step it is
///   /reference_position   [N, 3], undeformed
///   /connectivity         [N], 0..N-1: the points as cells, for XDMF
/// and the attributes `title` and `version`. Values are single precision unless asked otherwise.
///
/// All of it is laid out when the file is made, and its structure reaches the disk then: a step adds values
/// and nothing else, so whenever and however the program dies, all earlier steps can be read. A step that was
/// never written takes no disk space. `particles.xdmf` lists complete steps only, and is replaced in one
/// step.
#pragma once

#include <filesystem>
#include <functional>
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
struct PointSeriesPlan {
  std::filesystem::path directory;
  std::string basename = "particles";
  std::string title;
  std::string version;            ///< of the program
  std::vector<FieldInfo> fields;  ///< besides "position", which is always stored
  std::vector<long> steps;        ///< that will be written
  Precision precision = Precision::single_precision;
};

/// Writes a time series of a PointSource. Every call is collective and, if it fails on any rank (disk full),
/// throws RunError on all; what was written before stays readable.
class PointSeries {
 public:
  PointSeries(const PointSeriesPlan& plan, const PointLayout& layout, parallel::Communicator communicator);
  ~PointSeries();

  /// Stores /reference_position (m).
  void write_reference(const FieldView& undeformed_positions);

  /// Stores the fields of this moment and lists it, with its annotations, in the XDMF file. A step that was
  /// not planned goes to the one spare place, from which it displaces an earlier unplanned step.
  void write(PointSource& source);

 private:
  struct StoredField {
    std::string name, unit;
    int components;
  };
  struct ListedStep {
    std::string place, grid;  ///< name of its data sets; its XDMF text
  };

  void lay_out(Hdf5File& file, const PointSeriesPlan& plan) const;
  void write_connectivity();
  const void* packed(const FieldView& view, int components);
  void write_values(const std::string& dataset, int components, const std::function<FieldView()>& view);
  void reserve(const std::vector<std::string>& datasets);
  std::string xdmf_grid(const PointSource& source, const std::string& place) const;
  void write_xdmf() const;

  PointLayout layout_;
  std::vector<StoredField> fields_;  ///< "position" first
  Precision precision_;
  std::filesystem::path xdmf_path_;
  std::string hdf5_name_;
  parallel::Communicator communicator_;
  std::unique_ptr<Hdf5File> file_;
  std::map<long, std::string> planned_places_;
  std::vector<ListedStep> listed_;  ///< complete steps, in the order of writing
  std::vector<float> singles_;      ///< values on their way to the file, in the one precision
  std::vector<double> doubles_;     ///< or the other
};

}  // namespace rhexis::output
