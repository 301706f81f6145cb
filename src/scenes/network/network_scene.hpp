// SPDX-License-Identifier: BSD-3-Clause
/// The flow in a network of vessels.
#pragma once

#include "scenes/network/network_input.hpp"

namespace rhexis::scenes {

struct NetworkScene : SceneInput {
  static constexpr const char* model = "network";

  NetworkInput network;
  output::Parameters output;
  runtime::PicturesPlan pictures;
};

ParameterList declare(NetworkScene& s);

/// Throws InputError. Collective.
void resolve(NetworkScene& s, const Reading& reading);

output::FolderPlan folder_plan(const NetworkScene& s, const runtime::RunOptions& options);

}  // namespace rhexis::scenes
