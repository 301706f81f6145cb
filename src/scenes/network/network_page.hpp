// SPDX-License-Identifier: BSD-3-Clause
/// `rhexis network`: a page in the terminal about a network of the user's own, without solving anything.
#pragma once

#include <filesystem>

#include "network/parameters.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::scenes {

/// What is written besides the page; an empty path: nothing.
struct PageFiles {
  std::filesystem::path clean;    ///< the network as it was read and repaired, .json or .vtp
  std::filesystem::path picture;  ///< .png
  bool overwrite = false;
};

/// Prints counts, parts, ends, ranges, a histogram of radii, warnings and notes of the network of
/// `parameters.files`, and whether its flow can be solved. Throws InputError for files that cannot be read,
/// and where `files` are in the way or cannot be made; RunError where they cannot be written. Collective.
void print_network_page(const network::Parameters& parameters, const PageFiles& files,
                        parallel::Communicator comm);

}  // namespace rhexis::scenes
