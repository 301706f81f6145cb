// SPDX-License-Identifier: BSD-3-Clause
/// A body's fields over time, in the files `particles.h5` and `particles.xdmf` (see XdmfSeries),
/// `particles.vtkhdf` (see VtkHdfSeries), or both. Points lie in the order of their global numbers, whatever
/// rank has them.
#pragma once

#include "output/field_series.hpp"

namespace rhexis::output {

/// The files are called "particles" unless the plan says otherwise.
using PointSeriesPlan = SeriesPlan;

/// Writes a time series of a PointSource. Every call is collective and, if it fails on any rank (disk full),
/// throws RunError on all; what was written before stays readable.
class PointSeries {
 public:
  PointSeries(const PointSeriesPlan& plan, const IdRanges& points, parallel::Communicator communicator);

  /// Stores the undeformed positions (m).
  void write_reference(const FieldView& undeformed_positions);

  /// Stores the fields of this moment and lists it, with its annotations. A step that was not planned
  /// displaces an earlier unplanned step.
  void write(PointSource& source);
  /// See FieldSeries.
  void finish();

 private:
  std::vector<std::unique_ptr<FieldSeries>> formats_;
};

}  // namespace rhexis::output
