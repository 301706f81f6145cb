// SPDX-License-Identifier: BSD-3-Clause
/// A series as HDF5 and XDMF, which any ParaView reads.
///
/// `NAME.h5` holds N points and L lines, those of points in the order of their layout:
///   /FIELD/STEP           [N], [N, 3], [L] or [L, 3], the step in six digits, e.g. /displacement/000050;
///                         attribute `unit` on /FIELD
///   /FIELD/unplanned      as a step; used when a run ends early at a step that was not planned. The XDMF
///                         file tells which step it is
/// of points that move
///   /position/STEP        [N, 3]
///   /reference_position   [N, 3], undeformed
///   /connectivity         [N], 0..N-1: the points as cells, for XDMF
/// of points that stay, with lines between them
///   /position             [N, 3]; attribute `unit`
///   /connectivity         [L, 2], the points that a line joins, numbered over all ranks from 0
/// and the attributes `title` and `version`. Values are single precision unless asked otherwise.
/// `NAME.xdmf` lists the complete steps: see XdmfList.
#pragma once

#include "output/field_series.hpp"

namespace rhexis::output {

class XdmfList;

class XdmfSeries : public FieldSeries {
 public:
  XdmfSeries(const SeriesPlan& plan, const SeriesLayout& layout, SeriesKind kind,
             std::vector<StoredField> fields, parallel::Communicator communicator);

 protected:
  Place fixed_positions() const override;
  Place connectivity() const override;
  Place place_of(const StoredField& field, long step, bool planned, std::size_t entry) const override;
  std::function<void()> prepare(const SeriesStep& moment, bool planned, std::size_t entry) override;
  void unlist(std::size_t entry) override;

 private:
  void start_list(const SeriesStep& moment);
  std::string item(const Place& place, const char* type, int bytes) const;
  std::string reals(const Place& place) const;
  std::string grid(const SeriesStep& moment, bool planned) const;

  SeriesKind kind_;
  std::string basename_;
  std::filesystem::path list_path_;
  std::shared_ptr<XdmfList> list_;  ///< held by the root, from the first step on
};

}  // namespace rhexis::output
