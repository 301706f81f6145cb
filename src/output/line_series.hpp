/// A network's fields over time, such as pressures at junctions and flows in vessels: one parallel HDF5 file,
/// and an XDMF file that tells ParaView what is in it.
///
/// `network.h5` holds P points and L lines, those of the first rank first:
///   /position            [P, 3]; attribute `unit`
///   /connectivity        [L, 2], the points that a line joins, numbered over all ranks from 0
///   /<field>/<step>      [P], [P, 3], [L] or [L, 3], the step in six digits, e.g. /pressure/000050;
///   attribute
///                        `unit` on /<field>
///   /<field>/unplanned   as a step; used when a run ends early at a step that was not planned.
///                        `network.xdmf` tells which step it is, and which fields belong to lines
///                        (Center="Cell")
/// and the attributes `title` and `version`. Values are single precision unless asked otherwise. What is
/// written when, and what a crash leaves behind: see FieldSeries.
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

  /// Stores the fields of this moment and lists it, with its annotations, in the XDMF file. A step that was
  /// not planned goes to the one spare place, from which it displaces an earlier unplanned step.
  void write(LineSource& source);

 private:
  std::string xdmf_grid(const LineSource& source, const std::string& place) const;

  SeriesLayout layout_;
  FieldSeries series_;
};

}  // namespace rhexis::output
