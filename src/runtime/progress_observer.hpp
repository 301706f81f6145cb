// SPDX-License-Identifier: BSD-3-Clause
/// Shows at the terminal how far a run has come.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "core/observer.hpp"
#include "runtime/console.hpp"

namespace rhexis::runtime {

class ProgressObserver final : public Observer {
 public:
  /// Tells the progress among `steps` in all; `state`: a few words on the moment at hand. `console` must live
  /// on.
  ProgressObserver(Console& console, long steps, std::function<std::string()> state)
      : console_(console), steps_(steps), state_(std::move(state)) {}
  void arrive(const Moment& moment) override { console_.progress(moment.step, steps_, state_()); }

 private:
  Console& console_;
  long steps_;
  std::function<std::string()> state_;
};

}  // namespace rhexis::runtime
