// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/wall_model.hpp"

#include <algorithm>
#include <utility>

#include "peridynamics/bonds/surface_correction.hpp"
#include "peridynamics/engine/bond_kernel.hpp"
#include "peridynamics/engine/correspondence_kernel.hpp"
#include "peridynamics/engine/general_body.hpp"

namespace rhexis::peridynamics {

SharedWall make_wall(Parameters resolved, SharedFamilies families) {
  // Families take most of the time, so all that may be refused is made before them.
  BodySetup setup = make_setup(resolved, make_lattice(resolved), nullptr, 0);
  if (resolved.law.by_gradient()) {
    const TimeSteps time = time_steps(resolved, stable_time_step(resolved, setup));
    setup.time_step = time.step;
    GeneralTube tube = make_general_tube(resolved, setup);
    return std::make_shared<const WallModel>(
        WallModel{std::move(resolved), std::move(setup), std::move(tube), time});
  }
  setup.families = families ? std::move(families) : shared_families(resolved, setup.lattice);
  const TimeSteps time = time_steps(resolved, stable_time_step(setup));
  setup.time_step = time.step;
  return std::make_shared<const WallModel>(WallModel{std::move(resolved), std::move(setup), {}, time});
}

BondCount count_bonds(const WallModel& wall) {
  if (!wall.by_gradient())
    return {count_bonds(wall.lattice(), wall.families(), wall.is_periodic()),
            largest_family(wall.lattice(), wall.families(), wall.is_periodic())};
  const Neighbours& neighbours = wall.general.setup->geometry->neighbours;
  BondCount count{static_cast<std::int64_t>(neighbours.partner.size() / 2), 0};
  for (std::size_t i = 0; i < neighbours.size(); ++i)
    count.largest_family =
        std::max(count.largest_family, static_cast<std::int64_t>(neighbours.family_size(i)));
  return count;
}

double flop_per_evaluation(const WallModel& wall) {
  return wall.by_gradient() ? flop_per_directed_bond : 0.5 * flop_per_bond;
}

std::unique_ptr<Body> make_piece(const WallModel& wall, std::int64_t rows, parallel::Communicator comm) {
  BodySetup piece = wall.setup;
  piece.lattice.rows = rows;
  piece.ends = EndCondition::free;
  if (wall.by_gradient()) return make_body(make_general_tube(wall.parameters, piece).setup, comm);
  return make_body(std::move(piece), comm);
}

std::unique_ptr<Body> make_body(const WallModel& wall, parallel::Communicator comm) {
  return wall.by_gradient() ? make_body(wall.general.setup, comm) : make_body(wall.setup, comm);
}

}  // namespace rhexis::peridynamics
