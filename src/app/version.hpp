/// What this program is.
#pragma once

#include <string>

namespace rhexis::app {

std::string version();
std::string commit();
/// Version, commit, compiler, libraries: the text of `rhexis --version`.
std::string build_description();

}  // namespace rhexis::app
