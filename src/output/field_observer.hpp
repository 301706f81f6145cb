// SPDX-License-Identifier: BSD-3-Clause
/// Stores the fields of a run's particles while it goes on.
#pragma once

#include <algorithm>
#include <vector>

#include "core/observer.hpp"
#include "output/point_series.hpp"

namespace rhexis::output {

/// Writes a PointSource to a PointSeries at the steps of the plan and at the end.
class FieldObserver final : public Observer {
 public:
  /// Begins the files, with the undeformed positions (m). `source` must live on. Collective. Throws RunError.
  FieldObserver(const PointSeriesPlan& plan, PointSource& source, const FieldView& undeformed_positions,
                parallel::Communicator communicator)
      : source_(source), steps_(plan.steps), series_(plan, source.ids(), communicator) {
    series_.write_reference(undeformed_positions);
  }

  bool wants(const Moment& moment) override {
    return moment.last || std::ranges::binary_search(steps_, moment.step);
  }
  void observe(const Moment&) override { series_.write(source_); }
  /// Waits until all is on the disk.
  void end(const Moment&) override { series_.finish(); }

 private:
  PointSource& source_;
  std::vector<long> steps_;  ///< ascending
  PointSeries series_;
};

}  // namespace rhexis::output
