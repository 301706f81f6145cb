// SPDX-License-Identifier: BSD-3-Clause
/// What can be told of scripts without running them (inspection.py).
#pragma once

#include <string>
#include <vector>

#include "insitu/catalyst/channel.hpp"
#include "insitu/pipeline.hpp"

namespace rhexis::insitu {

/// Why no script can run on this system: a module that Python does not find; empty where there is none.
std::string missing_modules();

/// What each script wants, in the order of `settings.scripts`. Throws RunError, naming script
/// and line, for a script that cannot be read or parsed, or that asks for what the run does not have. Local
/// to the rank; ParaView need not have been started.
std::vector<std::vector<Wish>> inspect(const Settings& settings);

}  // namespace rhexis::insitu
