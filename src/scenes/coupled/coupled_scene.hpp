// SPDX-License-Identifier: BSD-3-Clause
/// The rupture of a vessel of a network, or of one after the other (a cascade).
#pragma once

#include "coupling/parameters.hpp"
#include "scenes/network/network_input.hpp"
#include "scenes/vessel/vessel_scene.hpp"

namespace rhexis::scenes {

struct CoupledScene : SceneInput {
  static constexpr const char* model = "coupled";

  coupling::Parameters coupling;
  NetworkInput network;
  peridynamics::Parameters vessel;  ///< as read; the network gives geometry and load
  output::Parameters output;
  runtime::PicturesPlan pictures;

  bool is_cascade() const { return coupling.events > 0; }
};

ParameterList declare(CoupledScene& s);

/// What can be told before the network is solved; the wall is made later, by `resolve_coupled_wall`. Throws
/// InputError. Collective.
void resolve(CoupledScene& s, const Reading& reading);

/// The scene's vessel, before the network has given geometry and load.
VesselScene vessel_of(const CoupledScene& s);

/// Makes the wall of a coupled vessel, once the network has given its geometry and its load. Throws
/// InputError, complete with place. Collective.
void resolve_coupled_wall(VesselScene& s, const Reading& reading);

/// Throws InputError that opens with `place` for a key that a coupled vessel takes from its network, or the
/// network from its vessel.
void refuse_coupled_key(const std::string& key, const std::string& place);

}  // namespace rhexis::scenes
