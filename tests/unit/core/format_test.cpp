// SPDX-License-Identifier: BSD-3-Clause
#include "core/format.hpp"

#include <gtest/gtest.h>

namespace rhexis {
namespace {

TEST(Format, GroupsDigitsByThree) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(-54800), "-54,800");
  EXPECT_EQ(grouped(34359738366), "34,359,738,366");
}

TEST(Format, TellsDurationsAsAClockDoes) {
  EXPECT_EQ(duration(3.14), "3.1 s");
  EXPECT_EQ(duration(59.4), "59 s");
  EXPECT_EQ(duration(200), "3 min 20 s");
  EXPECT_EQ(duration(7500), "2 h 5 min");
  EXPECT_EQ(duration(1 / 0.0), "?");
}

}  // namespace
}  // namespace rhexis
