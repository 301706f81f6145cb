// SPDX-License-Identifier: BSD-3-Clause
/// Reading in a process of its own: VTK ends the program that it is in, or never ends, where the numbers in a
/// file's tags do not fit its data.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "network/files/vtp/interface.hpp"

namespace rhexis::network::vtp {

/// Runs `read`, which fills lines and problem, in a child of this process, and takes over what it found. A
/// child that a signal ends, or that takes far longer or more memory than a file of `bytes` needs, is told in
/// `problem`. Nothing that the child prints is seen.
void read_in_child(const std::function<void(Lines&, std::string&)>& read, std::uintmax_t bytes, Lines& lines,
                   std::string& problem);

}  // namespace rhexis::network::vtp
