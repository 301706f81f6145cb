// SPDX-License-Identifier: BSD-3-Clause
/// A network's fields over time, such as pressures at junctions and flows in vessels, in the files
/// `network.h5` and `network.xdmf` (see XdmfSeries), `network.vtkhdf` (see VtkHdfSeries), or both. Points and
/// lines of the first rank come first.
///
///     output::LineSeries series({.directory = "results", .title = "...", .version = "...",
///                                .fields = {source.fields().begin(), source.fields().end()}, .steps = {0}},
///                               source, communicator);
///     series.write(source);
#pragma once

#include "output/field_series.hpp"

namespace rhexis::output {

/// The files are called "network" unless the plan says otherwise.
using LineSeriesPlan = SeriesPlan;

/// Writes a time series of a LineSource whose points do not move and whose lines stay. Every call is
/// collective and, if it fails on any rank (disk full), throws RunError on all; what was written before stays
/// readable.
class LineSeries {
 public:
  /// Lays out the files and stores positions and lines. Throws RunError if no rank has any line.
  LineSeries(const LineSeriesPlan& plan, LineSource& source, parallel::Communicator communicator);

  /// Stores the fields of this moment and lists it, with its annotations. A step that was not planned
  /// displaces an earlier unplanned step.
  void write(LineSource& source);

 private:
  std::vector<std::unique_ptr<FieldSeries>> formats_;
};

}  // namespace rhexis::output
