// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/tube_setup.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/format.hpp"

namespace rhexis::peridynamics {

GradientLaw gradient_law(const Parameters& p) {
  if (p.law.name == FibreReinforced::name)
    return FibreReinforced(wall_layers(p.law.wall), p.law.poisson_ratio);
  return NeoHookean(p.young_modulus, p.law.poisson_ratio);
}

GeneralTube make_general_tube(const Parameters& p, const Lattice& lattice, double time_step) {
  std::vector<std::size_t> order;
  auto setup = std::make_shared<GeneralSetup>();
  setup->geometry = make_geometry(tube_particles(lattice), *p.horizon, &order);
  setup->law = gradient_law(p);
  setup->density = p.density;
  setup->critical_stretch = *p.critical_stretch;
  setup->time_step = time_step;
  double volume = 0;
  for (const double v : setup->geometry->particles.volume) volume += v;
  setup->energy_scale =
      std::max(p.young_modulus * *p.critical_stretch * *p.critical_stretch, p.pressure) * volume;
  setup->double_bonds = p.bond_precision == Precision::double_precision;
  setup->follower_load = p.direction == LoadDirection::follower;
  if (p.ends != EndCondition::free) {
    const auto held_rows = static_cast<std::int64_t>(std::ceil(*p.end_length / lattice.row_spacing - 1e-9));
    if (2 * held_rows >= lattice.rows)
      throw InputError("the held ends (" + quantity(*p.end_length, "m") + ", or " +
                           std::to_string(held_rows) + " rows, each) leave none of the vessel's " +
                           std::to_string(lattice.rows) + " rows free",
                       "boundary.end_length");
    const std::uint8_t axes = p.ends == EndCondition::clamped ? 7 : 4;
    for (const std::size_t number : order) {
      const auto row = static_cast<std::int64_t>(number) % lattice.rows;
      setup->held.push_back(row < held_rows || row >= lattice.rows - held_rows ? axes : 0);
    }
  }
  return {std::move(setup), {order.begin(), order.end()}};
}

GeneralTube make_short_tube(const Parameters& p, Lattice lattice) {
  constexpr std::int64_t rows = 16;
  Parameters short_p = p;
  short_p.ends = EndCondition::sliding;
  short_p.end_length = lattice.row_spacing;
  short_p.bond_precision = Precision::double_precision;
  lattice.rows = rows;
  return make_general_tube(short_p, lattice, 1);
}

}  // namespace rhexis::peridynamics
