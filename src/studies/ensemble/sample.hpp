// SPDX-License-Identifier: BSD-3-Clause
/// One vessel of an ensemble: a wall under a pressure, until it ruptures or the time is over.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "peridynamics/wall_model.hpp"
#include "studies/ensemble/walls.hpp"

namespace rhexis::ensemble {

struct Sample {
  double pressure = 0;  ///< Pa
  std::int64_t wall = 0;
  SampledWall factors = {};
  bool ruptured = false;                               ///< damage of peridynamics::rupture_damage somewhere
  std::optional<double> onset = {}, first_break = {};  ///< s
  double max_displacement = 0;                         ///< m, at the onset or at the end
  std::int64_t steps = 0;                              ///< taken

  bool operator==(const Sample&) const = default;
};

/// By wall, then pressure: the order in which an ensemble is simulated and stored.
inline bool comes_before(const Sample& a, const Sample& b) {
  return a.wall != b.wall ? a.wall < b.wall : a.pressure < b.pressure;
}

/// Simulates wall number `wall`, drawn around the `mean` one, under `pressure` on this rank alone. Asks for a
/// `signal` at every step and gives nothing where there is one (other than 0). Adds to `bond_evaluations`.
/// Throws RunError, which names the sample, where the vessel becomes unstable.
std::optional<Sample> simulate(const Parameters& p, const peridynamics::WallModel& mean, double pressure,
                               std::int64_t wall, const std::function<int()>& signal,
                               std::int64_t& bond_evaluations);

}  // namespace rhexis::ensemble
