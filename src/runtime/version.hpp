// SPDX-License-Identifier: BSD-3-Clause
/// What this program is.
#pragma once

#include <string>

namespace rhexis::runtime {

std::string version();
std::string commit();
/// "GNU 12.2.0, Release, AVX3_DL": compiler, kind of build, vectors.
std::string compiler();
/// "5.11.0": the ParaView that pictures are made with; empty where there is none.
std::string paraview_version();
/// Version, commit, compiler, libraries: the text of `rhexis --version`.
std::string build_description();

}  // namespace rhexis::runtime
