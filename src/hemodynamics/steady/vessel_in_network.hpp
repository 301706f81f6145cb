// SPDX-License-Identifier: BSD-3-Clause
/// One vessel within the network around it: what its lumen and a leak do to pressures and flows.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hemodynamics/steady/tree/changed_tree.hpp"
#include "network/graph.hpp"

namespace rhexis::hemodynamics {

/// The steady flow, with the network's own conditions. Pressures are those that drive the flow: without the
/// weight of blood (hemodynamics/hydrostatic.hpp).
struct VesselState {
  double inflow = 0, outflow = 0;     ///< m3/s, of the network at all its ends, without the leak
  double flow_from = 0, flow_to = 0;  ///< m3/s, into the vessel and out of it at its ends
  double leak = 0;                    ///< m3/s
  double pressure_from = 0, pressure_middle = 0, pressure_to = 0;  ///< Pa

  /// What is lost or found, relative to the largest of the three: zero but for rounding.
  double imbalance() const;
};

class VesselInNetwork {
 public:
  virtual ~VesselInNetwork() = default;
  /// With `resistance_factor` on the vessel's resistance, and a leak half way along it of
  /// Q = leak_conductance (P - outside_pressure); m3/(s Pa), Pa. Local.
  virtual VesselState solve(double resistance_factor, double leak_conductance,
                            double outside_pressure) const = 0;
};

/// In a tree pair: the way from the root to the vessel is solved, O(k). Collective. `flow` must live on.
std::unique_ptr<VesselInNetwork> vessel_in_tree(const TreeFlow& flow, std::uint64_t vessel);

/// In a graph that fits into memory: all of it is solved each time.
std::unique_ptr<VesselInNetwork> vessel_in_graph(network::Graph graph, std::vector<double> conductance,
                                                 std::vector<network::BoundaryCondition> conditions,
                                                 std::uint32_t vessel);

}  // namespace rhexis::hemodynamics
