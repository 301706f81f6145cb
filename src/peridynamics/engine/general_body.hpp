// SPDX-License-Identifier: BSD-3-Clause
/// The general engine: a body of any shape whose law is evaluated at the deformation gradient.
#pragma once

#include <memory>

#include "peridynamics/engine/body.hpp"
#include "peridynamics/engine/general_setup.hpp"

namespace rhexis::peridynamics {

/// A body at rest at time 0. Collective.
std::unique_ptr<Body> make_body(std::shared_ptr<const GeneralSetup> setup, parallel::Communicator comm);

}  // namespace rhexis::peridynamics
