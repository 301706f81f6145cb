// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/tube_setup.hpp"

#include <utility>

namespace rhexis::peridynamics {

GradientLaw gradient_law(const Parameters& p) {
  if (p.law.name == FibreReinforced::name)
    return FibreReinforced(wall_layers(p.law.wall), p.law.poisson_ratio);
  return NeoHookean(p.young_modulus, p.law.poisson_ratio);
}

GeneralTube make_general_tube(const Parameters& p, const BodySetup& tube) {
  std::vector<std::size_t> order;
  auto setup = std::make_shared<GeneralSetup>();
  setup->geometry = make_geometry(tube_particles(tube.lattice), *p.horizon, &order);
  setup->law = gradient_law(p);
  setup->density = tube.density;
  setup->critical_stretch = tube.critical_stretch;
  setup->time_step = tube.time_step;
  setup->energy_scale = tube.energy_scale;
  setup->double_bonds = tube.double_bonds;
  setup->follower_load = p.direction == LoadDirection::follower;
  if (tube.ends != EndCondition::free) {
    for (const std::size_t number : order) {
      const std::int64_t row = static_cast<std::int64_t>(number) % tube.lattice.rows;
      std::uint8_t held = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const auto [first, past] = free_rows(tube, axis);
        if (row < first || row >= past) held = static_cast<std::uint8_t>(held | 1U << axis);
      }
      setup->held.push_back(held);
    }
  }
  return {std::move(setup), {order.begin(), order.end()}};
}

GeneralTube make_short_tube(const Parameters& p, BodySetup tube) {
  constexpr std::int64_t rows = 16;
  tube.ends = EndCondition::sliding;
  tube.end_length = tube.lattice.row_spacing;
  tube.double_bonds = true;
  tube.time_step = 1;
  tube.lattice.rows = rows;
  return make_general_tube(p, tube);
}

}  // namespace rhexis::peridynamics
