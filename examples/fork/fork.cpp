// SPDX-License-Identifier: BSD-3-Clause
// Steady flow of blood in a vessel that forks in two, by the libraries of an installed Rhexis:
//   cmake -B build -DCMAKE_PREFIX_PATH=/where/rhexis/is && cmake --build build && build/fork
#include <cstdio>

#include "hemodynamics/poiseuille.hpp"
#include "hemodynamics/steady/graph/graph_flow.hpp"

int main() {
  using rhexis::network::BoundaryCondition;
  rhexis::network::Graph fork{.junctions = 4, .from = {0, 1, 1}, .to = {1, 2, 3}};
  fork.radius = {2e-3, 1.6e-3, 1.2e-3}, fork.length = {40e-3, 30e-3, 30e-3};  // m
  std::vector<double> conductance;
  for (std::size_t v = 0; v < fork.vessels(); ++v)
    conductance.push_back(
        1 / rhexis::hemodynamics::poiseuille_resistance(fork.radius[v], fork.length[v], 3.5e-3));
  const std::vector<BoundaryCondition> ends = {
      {.junction = 0, .value = 12e3}, {.junction = 2}, {.junction = 3}};  // Pa
  const auto flow = rhexis::hemodynamics::solve_flow(fork, conductance, ends);
  for (std::size_t v = 0; v < fork.vessels(); ++v)
    std::printf("vessel %zu: %.4g mL/s\n", v, flow.flow[v] * 1e6);
}
