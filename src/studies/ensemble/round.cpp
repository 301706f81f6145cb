// SPDX-License-Identifier: BSD-3-Clause
#include "studies/ensemble/round.hpp"

#include <algorithm>
#include <exception>
#include <set>
#include <utility>

#include "core/stopwatch.hpp"
#include "parallel/exchange.hpp"

namespace rhexis::ensemble {

std::vector<Task> tasks_left(const Parameters& p, const std::vector<Sample>& done) {
  std::set<std::pair<std::int64_t, double>> known;
  for (const Sample& s : done) known.emplace(s.wall, s.pressure);
  std::vector<Task> tasks;
  for (std::int64_t wall = 0; wall < p.samples; ++wall)
    for (const double pressure : p.pressures)
      if (!known.contains({wall, pressure})) tasks.push_back({wall, pressure});
  return tasks;
}

Round simulate_round(const Parameters& p, const peridynamics::WallModel& mean, std::span<const Task> tasks,
                     const std::function<bool()>& stop, parallel::Communicator comm,
                     std::int64_t& bond_evaluations, double& seconds) {
  const auto ranks = static_cast<std::size_t>(comm.size()), rank = static_cast<std::size_t>(comm.rank());
  Round round;
  std::vector<Sample> own;
  try {
    const Stopwatch watch(seconds);
    for (std::size_t turn = 0; turn * ranks < tasks.size(); ++turn) {
      // To and fro, for higher pressures take less time.
      const std::size_t i = turn * ranks + (turn % 2 == 0 ? rank : ranks - 1 - rank);
      if (i >= tasks.size()) continue;
      const auto sample = simulate(p, mean, tasks[i].pressure, tasks[i].wall, stop, bond_evaluations);
      if (!sample) break;
      own.push_back(*sample);
    }
  } catch (const std::exception& error) {
    round.failure = error.what();
  }
  round.samples = parallel::all_gather(comm, own).records;
  std::sort(round.samples.begin(), round.samples.end(), comes_before);
  round.failure = comm.first_non_empty(round.failure);
  return round;
}

}  // namespace rhexis::ensemble
