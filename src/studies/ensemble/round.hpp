// SPDX-License-Identifier: BSD-3-Clause
/// An ensemble's vessels, dealt out among the ranks round by round.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "parallel/communicator.hpp"
#include "studies/ensemble/sample.hpp"

namespace rhexis::ensemble {

/// A vessel to simulate.
struct Task {
  std::int64_t wall = 0;
  double pressure = 0;  ///< Pa
};

/// The vessels of the ensemble that are not among `done`, wall by wall, so that the curves of all pressures
/// grow together.
std::vector<Task> tasks_left(const Parameters& p, const std::vector<Sample>& done);

struct Round {
  std::vector<Sample> samples;  ///< finished ones of all ranks, in their order (see `comes_before`)
  std::string failure;          ///< why a sample of one rank failed; empty: none did
};

/// Simulates the tasks, each on one rank, around the `mean` wall. A rank that is told to `stop` leaves its
/// rest. Adds this rank's own to `bond_evaluations` and, in s, to `seconds`. Collective: the same on all
/// ranks.
Round simulate_round(const Parameters& p, const peridynamics::WallModel& mean, std::span<const Task> tasks,
                     const std::function<bool()>& stop, parallel::Communicator comm,
                     std::int64_t& bond_evaluations, double& seconds);

}  // namespace rhexis::ensemble
