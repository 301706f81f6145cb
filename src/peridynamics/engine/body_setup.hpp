// SPDX-License-Identifier: BSD-3-Clause
/// What a body is made of: all that the engine needs, resolved.
#pragma once

#include <cstdint>
#include <utility>

#include "peridynamics/bonds/bond_family.hpp"
#include "peridynamics/geometry/heterogeneity.hpp"
#include "peridynamics/loads/lumen_surface.hpp"
#include "peridynamics/loads/thin_spots.hpp"

namespace rhexis::peridynamics {

struct BodySetup {
  Lattice lattice;
  SharedFamilies families;
  double inner_radius = 0;  ///< m
  PressureLayer layer;      ///< the load on the undeformed wall
  LumenSurface lumen = {};  ///< where the load follows the wall; none: it is dead
  EndCondition ends = EndCondition::free;
  double end_length = 0;  ///< m held at each end
  double density = 0;     ///< kg/m3
  LawChoice law = {};
  double bond_constant = 0;  ///< N/m6
  double critical_stretch = 0;
  double time_step = 0;     ///< s
  double energy_scale = 0;  ///< J, order of magnitude of the energies that will occur
  bool double_bonds = false;
  Heterogeneity heterogeneity = {};
  ThinSpots thin_spots = {};
};

/// The setup that resolved parameters describe.
BodySetup make_setup(const Parameters& p, Lattice lattice, SharedFamilies families, double time_step);

/// Rows of the whole body, [first, past), whose motion along axis `component` the ends do not hold: clamped
/// ends hold all components, sliding ones the axial one.
std::pair<std::int64_t, std::int64_t> free_rows(const BodySetup& setup, int component);

}  // namespace rhexis::peridynamics
