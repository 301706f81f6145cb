// SPDX-License-Identifier: BSD-3-Clause
/// What scripts call the things that a run shows, and what they want of them.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace rhexis::insitu {

/// Channels are numbered in the order of the members of `Channels`: particles, network.
inline constexpr std::size_t channel_count = 2;
template <class Value>
using PerChannel = std::array<Value, channel_count>;

/// The names under which scripts find a channel: its own, and that of the file which the solver saves, so
/// that a script exported from a ParaView session on this file runs unchanged.
inline constexpr PerChannel<std::array<const char*, 2>> channel_names = {
    {{"particles", "particles.xdmf"}, {"network", "network.xdmf"}}};

/// What one script wants of one channel.
struct Wish {
  bool wanted = false;              ///< it is given the channel
  std::vector<std::string> fields;  ///< names
};

}  // namespace rhexis::insitu
