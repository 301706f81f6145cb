// SPDX-License-Identifier: BSD-3-Clause
/// What is left of all ranks' parts, on every rank, solved there as one small network. All ranks do the same
/// with the same digits.
#pragma once

#include <cstdint>
#include <vector>

#include "hemodynamics/steady/graph/graph_flow.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::hemodynamics {

struct CorePart {
  struct Vessel {
    std::int64_t tail, head;  ///< ids of junctions
    double conductance;
  };
  struct Junction {
    std::int64_t id;
    double value;  ///< injection, m3/s, of which each rank gives its part; or pressure, Pa
    bool fixed;
  };
  std::vector<Vessel> vessels;
  std::vector<Junction>
      junctions;  ///< all that the vessels touch, and those that other ranks' vessels may touch
};

struct CorePartSolution {
  std::vector<double> flow, pressure;  ///< in the part's vessels and at its junctions
  GraphSolver solver = GraphSolver::automatic;
  std::int64_t iterations = 0, core_junctions = 0;
};

/// Collective.
CorePartSolution solve_gathered(const CorePart& part, const GraphSolverOptions& options,
                                parallel::Communicator comm);

}  // namespace rhexis::hemodynamics
