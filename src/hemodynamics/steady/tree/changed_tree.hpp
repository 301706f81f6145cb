// SPDX-License-Identifier: BSD-3-Clause
/// The tree pair after something happened to a few of its vessels: another resistance (a lumen that widened
/// or narrowed), or a leak through the wall.
///
/// Only the ways from the root to the changed vessels are solved anew: everything that hangs off them is one
/// known resistance. So a change costs O(k) unknowns, whatever the size of the tree. The leak leaves a vessel
/// half way along it and is driven by the pressure there over that outside:  Q = G (P - P_outside).
#pragma once

#include <cstdint>
#include <vector>

#include "hemodynamics/steady/tree/tree_flow.hpp"

namespace rhexis::hemodynamics {

struct VesselChange {
  std::uint64_t vessel = 0;      ///< id
  double resistance_factor = 1;  ///< on the vessel's resistance
  double leak_conductance = 0;   ///< G, m3/(s Pa)
  double outside_pressure = 0;   ///< Pa
};

/// A changed vessel in the new flow.
struct ChangedVessel {
  double flow_from = 0, flow_to = 0;  ///< m3/s, into the vessel and out of it at its ends; differ by the leak
  double leak = 0;                    ///< m3/s
  double pressure_from = 0, pressure_middle = 0, pressure_to = 0;  ///< Pa
};

/// Solves for any changes of a fixed set of vessels; finding the ways to them (once) is the costly part.
class ChangedTree {
 public:
  /// Collective. Throws InputError for a vessel that does not exist or is named twice.
  ChangedTree(const TreeFlow& flow, std::vector<std::uint64_t> vessels);

  struct Result {
    double inflow = 0, outflow = 0;      ///< m3/s, at the roots; differ by all leaks
    std::vector<ChangedVessel> vessels;  ///< in the order of the changes
  };

  /// The new steady flow, with the boundary of the unchanged tree: pressures, or a pressure and the flow.
  /// Local; O(k) for each vessel. `changes`: of vessels named before, in any order, at most one each; the
  /// others are as they were.
  Result solve(const std::vector<VesselChange>& changes) const;

 private:
  struct Place {
    std::uint64_t place;
    double artery, vein;  ///< resistances, Pa s/m3
    double below;         ///< resistance of what hangs below and is not on a way; 0: nothing
  };
  const TreeFlow& flow_;
  std::vector<std::uint64_t> vessels_;
  std::vector<Place> places_;  ///< ascending
};

}  // namespace rhexis::hemodynamics
