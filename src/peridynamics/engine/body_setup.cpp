// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/engine/body_setup.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/format.hpp"
#include "peridynamics/laws/all_laws.hpp"

namespace rhexis::peridynamics {

BodySetup make_setup(const Parameters& p, Lattice lattice, SharedFamilies families, double time_step) {
  BodySetup setup;
  setup.inner_radius = p.inner_radius;
  setup.layer = make_pressure_layer(p, lattice);
  if (p.direction == LoadDirection::follower) {
    setup.lumen = make_lumen_surface(p, lattice, setup.layer);
    setup.layer = undeformed_load(setup.lumen, lattice);
  }
  setup.lattice = std::move(lattice);
  setup.families = std::move(families);
  setup.ends = p.ends;
  setup.end_length = *p.end_length;
  setup.density = p.density;
  setup.law = p.law;
  if (!p.law.by_gradient())
    setup.bond_constant =
        with_law(setup.law, [&](const auto& law) { return law.bond_constant(p.young_modulus, *p.horizon); });
  setup.critical_stretch = *p.critical_stretch;
  setup.time_step = time_step;
  // Strain energy of the whole wall at the critical stretch, or the pressure on as much: what happens stays
  // within some powers of ten of it.
  const double volume = static_cast<double>(setup.lattice.particles()) * setup.lattice.volume(0);
  setup.energy_scale =
      std::max(p.young_modulus * *p.critical_stretch * *p.critical_stretch, p.pressure) * volume;
  setup.double_bonds = p.bond_precision == Precision::double_precision;
  setup.heterogeneity = Heterogeneity(p);
  setup.thin_spots = ThinSpots(p, setup.lattice, setup.layer);
  if (const auto [first, past] = free_rows(setup, 2); first == past) {
    throw InputError("the held ends (" + quantity(setup.end_length, "m") + ", or " + std::to_string(first) +
                         " rows, each) leave none of the vessel's " + std::to_string(setup.lattice.rows) +
                         " rows free",
                     "boundary.end_length");
  }
  return setup;
}

std::pair<std::int64_t, std::int64_t> free_rows(const BodySetup& setup, int component) {
  const std::int64_t rows = setup.lattice.rows;
  const bool held =
      setup.ends == EndCondition::clamped || (setup.ends == EndCondition::sliding && component == 2);
  if (!held) return {0, rows};
  const auto first =
      static_cast<std::int64_t>(std::ceil(setup.end_length / setup.lattice.row_spacing - 1e-9));
  return {first, std::max(first, rows - first)};
}

}  // namespace rhexis::peridynamics
