// SPDX-License-Identifier: BSD-3-Clause
// Runs a GoogleTest program on every rank; the program fails if any rank fails.
#include <gtest/gtest.h>

#include "parallel/communicator.hpp"

int main(int argc, char** argv) {
  rhexis::parallel::Session session(argc, argv);
  testing::InitGoogleTest(&argc, argv);
  const int failed = RUN_ALL_TESTS();
  return static_cast<int>(rhexis::parallel::Communicator::world().all_reduce(std::int64_t{failed},
                                                                             rhexis::parallel::Reduce::max));
}
