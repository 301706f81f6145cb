// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/wall_model.hpp"

#include <utility>

#include "peridynamics/bonds/surface_correction.hpp"

namespace rhexis::peridynamics {

SharedWall make_wall(Parameters resolved, SharedFamilies families) {
  // Families take most of the time, so all that may be refused is made before them.
  BodySetup setup = make_setup(resolved, make_lattice(resolved), nullptr, 0);
  setup.families = families ? std::move(families) : shared_families(resolved, setup.lattice);
  const TimeSteps time = time_steps(resolved, setup);
  setup.time_step = time.step;
  return std::make_shared<const WallModel>(
      WallModel{.parameters = std::move(resolved), .setup = std::move(setup), .time = time});
}

}  // namespace rhexis::peridynamics
