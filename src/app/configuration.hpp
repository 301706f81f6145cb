// SPDX-License-Identifier: BSD-3-Clause
/// The scenes that an input file may describe, and the keys of each.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/parameter.hpp"
#include "scenes/coupled/coupled_scene.hpp"
#include "scenes/ensemble/ensemble_scene.hpp"
#include "scenes/network/network_scene.hpp"
#include "scenes/vessel/vessel_scene.hpp"

namespace rhexis::app {

/// What an input file amounts to: one kind of scene, resolved. A new kind is a room of scenes/ and its name
/// here.
using Configuration =
    std::variant<scenes::VesselScene, scenes::NetworkScene, scenes::CoupledScene, scenes::EnsembleScene>;

inline const scenes::SceneInput& input_of(const Configuration& c) {
  return std::visit([](const scenes::SceneInput& s) -> const scenes::SceneInput& { return s; }, c);
}
inline scenes::SceneInput& input_of(Configuration& c) {
  return std::visit([](scenes::SceneInput& s) -> scenes::SceneInput& { return s; }, c);
}

/// Its value of scene.model.
inline std::string model_of(const Configuration& c) {
  return std::visit([](const auto& s) -> std::string { return s.model; }, c);
}

/// The wall that is known before the scene is run; null where none is.
inline const peridynamics::WallModel* wall_of(const Configuration& c) {
  return std::visit(
      [](const auto& s) -> const peridynamics::WallModel* {
        if constexpr (requires { s.wall; }) return s.wall.get();
        return nullptr;
      },
      c);
}

/// Reads and validates `file` with `overrides`, resolves what follows from them, and notes in `reading` what
/// that took. Only the keys of the scene's kind are read; any other is an error. Collective: one rank reads,
/// all get the same configuration or the same InputError.
Configuration read_configuration(const std::string& file, const std::vector<std::string>& overrides,
                                 scenes::Reading& reading);

}  // namespace rhexis::app
