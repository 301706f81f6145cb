// SPDX-License-Identifier: BSD-3-Clause
/// A series as VTKHDF, the HDF5 file format of VTK: one file, which ParaView 5.12 and later reads as poly
/// data over time.
///
/// `NAME.vtkhdf`, group /VTKHDF (version 2.2 of the format), for N points, C cells (a vertex at each
/// point, or L lines) and room for S steps, the planned ones and one more:
///   Points                        [S N, 3] of points that move, else [N, 3]; attribute `unit`
///   PointData/FIELD               [S N] or [S N, 3]; attribute `unit`
///   PointData/reference_position  [N, 3], undeformed, the same at every step; only of points that move
///   CellData/FIELD                [S C] or [S C, 3]
///   Vertices, Lines, Polygons, Strips: the cells, the same at every step
///   FieldData/ANNOTATION          [S], and `step`, the number of the step
///   Steps                         attribute NSteps; Values [NSteps] (s), and where each step begins in the
///   others
/// and the attributes `title` and `version` of the file. Steps are stored in the order of writing. What is
/// behind the last step means nothing yet.
///
/// What lists a step is NSteps, and the extent of Values (with an address once there are any), which readers
/// take to agree. All lie in the file's first page and are written last, by one write beside HDF5 (which
/// would rewrite whole headers, and lock the file against readers): a program is not killed within a page, so
/// that they count complete steps, whenever it dies. A reader that opens the file just then may see one
/// number and not yet the other.
#pragma once

#include <map>

#include "output/field_series.hpp"

namespace rhexis::output {

class Hdf5File;

class VtkHdfSeries : public FieldSeries {
 public:
  VtkHdfSeries(const SeriesPlan& plan, const SeriesLayout& layout, SeriesKind kind,
               std::vector<StoredField> fields, parallel::Communicator communicator);

  /// The part of the file's first page in which the number of steps lies several times.
  struct StepCounts {
    std::int64_t at = 0;         ///< bytes from the beginning of the file: NSteps
    std::string bytes;           ///< from there to the address of Values, its last number
    std::size_t extent = 0;      ///< within `bytes`: the extent of Values, now and at most
    std::int64_t values_at = 0;  ///< bytes from the beginning of the file: Values
  };

 protected:
  Place fixed_positions() const override;
  Place connectivity() const override;
  Place place_of(const StoredField& field, long step, bool planned, std::size_t entry) const override;
  std::function<void()> prepare(const SeriesStep& moment, bool planned, std::size_t entry) override;
  void unlist(std::size_t entry) override;

 private:
  std::string dataset_of(const StoredField& field) const;
  std::int64_t count(Centring centring) const;
  void lay_out(Hdf5File& h5, const SeriesPlan& plan) const;
  void lay_out_cells(Hdf5File& h5) const;
  void lay_out_steps(Hdf5File& h5) const;
  void write_offsets();
  std::string counts_of(std::size_t steps) const;
  Place offsets() const;

  SeriesKind kind_;
  std::int64_t room_;                     ///< steps there is room for
  std::vector<std::string> annotations_;  ///< and `step`
  std::map<std::string, std::int64_t>
      numbers_at_;     ///< where data sets of one number a step begin in the file
  StepCounts counts_;  ///< the root's alone
};

}  // namespace rhexis::output
