// SPDX-License-Identifier: BSD-3-Clause
/// `rhexis network`: a page in the terminal about a network of the user's own, without solving anything.
#pragma once

#include <filesystem>

#include "network/parameters.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::scenes {

/// Where the network is written as it was read and repaired.
struct CleanFile {
  std::filesystem::path path;  ///< .json or .vtp; empty: nowhere
  bool overwrite = false;
};

/// Prints counts, parts, ends, ranges, a histogram of radii, warnings and notes of the network of
/// `parameters.files`, and whether its flow can be solved. Throws InputError for files that cannot be read,
/// and where `clean` is in the way; RunError where that cannot be written. Collective.
void print_network_page(const network::Parameters& parameters, const CleanFile& clean,
                        parallel::Communicator comm);

}  // namespace rhexis::scenes
