// SPDX-License-Identifier: BSD-3-Clause
/// The rupture of one vessel's wall.
#pragma once

#include <vector>

#include "scenes/vessel/wall_input.hpp"

namespace rhexis::scenes {

struct VesselScene : SceneInput {
  static constexpr const char* model = "vessel";

  peridynamics::Parameters vessel;  ///< as read
  output::Parameters output;
  runtime::PicturesPlan pictures;

  peridynamics::SharedWall wall = {};   ///< what `vessel` is resolved to
  std::vector<long> output_steps = {};  ///< numbers of the time steps that are stored
};

ParameterList declare(VesselScene& s);

/// Throws InputError. Collective.
void resolve(VesselScene& s, const Reading& reading);

/// Makes s.wall and plans its outputs. Throws InputError. Collective.
void resolve_wall(VesselScene& s, const peridynamics::WallDemand& demand, const Reading& reading);

}  // namespace rhexis::scenes
