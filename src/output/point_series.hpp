/// A body's fields over time: one parallel HDF5 file, and an XDMF file that tells ParaView what is in it.
///
/// `particles.h5` holds, in the partition-independent order id = column * rows + row:
///   /<field>/<step>       [N] or [N, 3], the step in six digits, e.g. /displacement/000050; attribute `unit`
///                         on /<field>
///   /position/<step>      [N, 3], deformed
///   /<field>/unplanned    as a step; used when a run ends early at a step that was not planned.
///                         `particles.xdmf` tells which step it is
///   /reference_position   [N, 3], undeformed
///   /connectivity         [N], 0..N-1: the points as cells, for XDMF
/// and the attributes `title` and `version`. Values are single precision unless asked otherwise. What is
/// written when, and what a crash leaves behind: see FieldSeries.
#pragma once

#include "output/field_series.hpp"

namespace rhexis::output {

/// The files are called "particles" unless the plan says otherwise.
using PointSeriesPlan = SeriesPlan;

/// Writes a time series of a PointSource. Every call is collective and, if it fails on any rank (disk full),
/// throws RunError on all; what was written before stays readable.
class PointSeries {
 public:
  PointSeries(const PointSeriesPlan& plan, const PointLayout& layout, parallel::Communicator communicator);

  /// Stores /reference_position (m).
  void write_reference(const FieldView& undeformed_positions);

  /// Stores the fields of this moment and lists it, with its annotations, in the XDMF file. A step that was
  /// not planned goes to the one spare place, from which it displaces an earlier unplanned step.
  void write(PointSource& source);
  /// See FieldSeries.
  void finish() { series_.finish(); }

 private:
  std::string xdmf_grid(const PointSource& source, const std::string& place) const;

  PointLayout layout_;
  FieldSeries series_;
};

}  // namespace rhexis::output
