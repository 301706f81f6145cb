// SPDX-License-Identifier: BSD-3-Clause
/// What a scene has to draw.
#pragma once

#include "runtime/run_session.hpp"
#include "scenes/configuration.hpp"

namespace rhexis::scenes {

/// The scripts of the input and the fields that they may ask for.
runtime::PicturesPlan pictures_plan(const Configuration& c);

/// What a run says of the scene in its header, its record and its pictures.
runtime::Scene scene_of(const Configuration& c);

/// The scripts named in the input become absolute paths, and `c.no_pictures` says why there can be none
/// (runtime/pictures.hpp). Collective; throws InputError of the key insitu.scripts.
void find_scripts(Configuration& c, parallel::Communicator comm);

}  // namespace rhexis::scenes
