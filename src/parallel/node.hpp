// SPDX-License-Identifier: BSD-3-Clause
/// What the ranks of one machine share.
#pragma once

#include <string>

#include "parallel/communicator.hpp"

namespace rhexis::parallel {

/// Ranks of `comm` on the machine of this one. Collective.
int ranks_of_node(const Communicator& comm);

/// What OMP_NUM_THREADS had that cannot be taken, and what is done instead; empty where it is as asked.
const std::string& threads_notice();

}  // namespace rhexis::parallel
