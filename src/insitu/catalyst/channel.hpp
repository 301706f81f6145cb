// SPDX-License-Identifier: BSD-3-Clause
/// What scripts call the things that a run shows, and what they want of them.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace rhexis::insitu {

/// The names under which scripts find a channel: its own, and that of the file which the solver saves, so
/// that a script exported from a ParaView session on this file runs unchanged.
inline std::array<std::string, 2> script_names(const std::string& channel) {
  return {channel, channel + ".xdmf"};
}

/// What a script wants of a channel: the fields of these names.
struct Wish {
  std::string channel;
  std::vector<std::string> fields;
};

}  // namespace rhexis::insitu
