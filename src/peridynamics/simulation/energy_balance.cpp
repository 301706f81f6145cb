// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/simulation/energy_balance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/format.hpp"

namespace rhexis::peridynamics {

UnstableError::UnstableError(const VesselSimulation& simulation, const std::string& sign)
    : RunError(fmt::format(
          "the run became unstable by step {} ({}): {}; use a smaller time.step (now {}; {} is "
          "stable while strains are small)",
          simulation.step_number(), quantity(simulation.time(), "s"), sign,
          quantity(simulation.time_steps().step, "s"), quantity(simulation.time_steps().stable, "s"))),
      step(simulation.step_number()) {}

bool EnergyBalance::wants(const Moment& moment) {
  if (moment.last || std::ranges::binary_search(steps_, moment.step)) return true;
  const std::optional<double> first_break = simulation_.rupture().first_break;
  if (!first_break) return false;
  const long since = moment.step - std::lround(*first_break / simulation_.time_steps().step);
  return since > 0 && std::has_single_bit(static_cast<unsigned long>(since));
}

void EnergyBalance::observe(const Moment& moment) {
  // Leapfrog's velocity is half a step ahead of the work: after one step of a ramp from zero it is all there
  // is.
  if (moment.step < 2 || holds_no_more_than_was_put_in(simulation_.totals())) return;
  throw UnstableError(simulation_, "the wall holds more energy than the load has put in");
}

bool CrushedBonds::wants(const Moment& moment) {
  return moment.last || std::ranges::binary_search(steps_, moment.step);
}

void CrushedBonds::observe(const Moment& moment) {
  const std::int64_t crushed = simulation_.totals().crushed_bonds;
  if (crushed == 0 || told_) return;
  told_ = true;
  const std::string step = quantity(simulation_.time_steps().step, "s");
  warn_(
      fmt::format("at {} {} bonds are compressed to less than half their length, where {} is no longer "
                  "known to be stable: the run will stop if energy exceeds the work done by a tenth; a "
                  "smaller time.step is safer",
                  quantity(moment.time_s, "s"), grouped(crushed), step));
}

}  // namespace rhexis::peridynamics
