// SPDX-License-Identifier: BSD-3-Clause
#include "parallel/link.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace rhexis::parallel {
namespace {

TEST(Link, IsMeasuredBetweenRanksAndKnownToAll) {
  const auto world = Communicator::world();
  const auto link = measure_link(world);
  ASSERT_EQ(link.has_value(), world.size() > 1);
  if (!link) return;
  for (const double value : {link->latency_s, link->bandwidth_B_s}) {
    EXPECT_GT(value, 0);
    EXPECT_TRUE(std::isfinite(value));
    EXPECT_EQ(world.all_reduce(value, Reduce::min), world.all_reduce(value, Reduce::max));
  }
}

}  // namespace
}  // namespace rhexis::parallel
