// SPDX-License-Identifier: BSD-3-Clause
/// Draws what a run shows while it goes on.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "core/observer.hpp"
#include "runtime/pictures.hpp"

namespace rhexis::runtime {

/// Runs the scripts that want a moment: every so many steps, or with the output; and at the end, but there,
/// with `every_steps`, only where the run ends by itself.
class PictureObserver final : public Observer {
 public:
  struct Plan {
    std::optional<std::int64_t> every_steps = {};
    std::span<const long> output_steps = {};  ///< ascending; must live on
    /// What there is to see at the moment at hand.
    std::function<insitu::Channels()> channels = {};
  };
  /// `pictures` must live on; no picture is drawn where they have no pipeline.
  PictureObserver(Pictures& pictures, Plan plan) : pictures_(pictures), plan_(std::move(plan)) {}

  bool wants(const Moment& moment) override {
    // Scripts are asked last: the answer may need all ranks.
    return due(moment) && pictures_.wants(moment.step, moment.time_s);
  }
  void observe(const Moment& moment) override {
    pictures_.process(moment.step, moment.time_s, plan_.channels());
  }

 private:
  bool due(const Moment& moment) const {
    if (plan_.every_steps)
      return moment.step % *plan_.every_steps == 0 || (moment.last && moment.signal == 0);
    return moment.first || moment.last || std::ranges::binary_search(plan_.output_steps, moment.step);
  }

  Pictures& pictures_;
  Plan plan_;
};

}  // namespace rhexis::runtime
