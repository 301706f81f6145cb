// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/simulation/time_loop.hpp"

#include <bit>
#include <cstdint>
#include <utility>

#include "core/error.hpp"
#include "core/stopwatch.hpp"
#include "peridynamics/simulation/energy_balance.hpp"

namespace rhexis::peridynamics {
namespace {

/// A signal as a bit of what ranks tell each other after every step.
std::uint64_t flag_of_signal(int signal) {
  return signal == 0 ? 0 : std::uint64_t{1} << signal;
}

/// One of the signals that ranks have got, the same on all; 0 where there is none.
int signal_in(std::uint64_t flags) {
  return flags == 0 ? 0 : std::countr_zero(flags);
}

}  // namespace

TimeLoop::TimeLoop(VesselSimulation& simulation, LoadSource& load, LoopPlan plan)
    : simulation_(simulation), load_(load), plan_(std::move(plan)) {}

void TimeLoop::subscribe(Observer& observer, double* seconds) {
  observers_.push_back({&observer, seconds != nullptr ? seconds : &unseen_});
}

template <class Call>
void TimeLoop::for_each_observer(const Call& call) {
  for (const Subscription& subscription : observers_) {
    const Stopwatch watch(*subscription.seconds);
    call(*subscription.observer);
  }
}

int TimeLoop::run() {
  int signal = 0;
  for (bool first = true;; first = false) {
    const long now = simulation_.step_number();
    const bool ruptured = plan_.ends_at_rupture && simulation_.rupture().onset;
    const Moment moment{.step = now,
                        .time_s = simulation_.time(),
                        .first = first,
                        .last = signal != 0 || now >= plan_.steps || ruptured,
                        .signal = signal};
    for_each_observer([&](Observer& o) { o.arrive(moment); });
    {
      const Stopwatch watch(*seconds_);
      load_.at_moment(simulation_);
    }
    observe(moment);
    if (moment.last) {
      simulation_.conclude();
      for_each_observer([&](Observer& o) { o.end(moment); });
      return signal;
    }
    signal = step(moment);
  }
}

/// Has those observe the moment who want to.
void TimeLoop::observe(const Moment& moment) {
  std::vector<Subscription> wanting;
  for (const Subscription& subscription : observers_) {
    if (subscription.observer->wants(moment)) wanting.push_back(subscription);
  }
  if (wanting.empty()) return;
  try {
    {
      const Stopwatch watch(*seconds_);
      // Once, for what is observed and for the next step.
      simulation_.body().find_forces(simulation_.pressure());
    }
    {
      const Stopwatch watch(*wanting.front().seconds);
      simulation_.observe();
    }
    for (const Subscription& subscription : wanting) {
      const Stopwatch watch(*subscription.seconds);
      subscription.observer->observe(moment);
    }
  } catch (const UnstableError&) {  // a state of no use
    throw;
  } catch (const RunError&) {
    for_each_observer([&](Observer& o) { o.rescue(moment); });
    throw;
  }
}

/// Takes the step after a moment; returns the signal that it has brought.
int TimeLoop::step(const Moment& moment) {
  const Stopwatch watch(*seconds_);
  const auto report = simulation_.step(load_, flag_of_signal(plan_.signal ? plan_.signal() : 0));
  if (report.unstable) throw UnstableError(simulation_, "a particle outran what the load can do");
  return moment.step + 1 < plan_.steps ? signal_in(report.flags) : 0;  // after the last step it is done
}

}  // namespace rhexis::peridynamics
