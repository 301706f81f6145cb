// SPDX-License-Identifier: BSD-3-Clause
/// Which keys a scene has: those of its model, with what their values are put into.
#pragma once

#include <string>

#include "app/configuration.hpp"
#include "input/document.hpp"

namespace rhexis::app {

/// The keys of the scene's model, as the document gives it. Throws InputError for a key of another model's.
ParameterList declare_model(Configuration& c, const input::Document& document);

}  // namespace rhexis::app
