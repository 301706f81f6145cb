// SPDX-License-Identifier: BSD-3-Clause
// Eq. (7), term by term.
#include "coupling/net_pressure.hpp"

#include <gtest/gtest.h>

#include "coupling/parameters.hpp"

namespace rhexis::coupling {
namespace {

TEST(NetPressure, EveryTermWithItsSign) {
  const PressureParts heart{.heart = 12000};
  EXPECT_EQ(net_pressure(heart), 12000);
  EXPECT_EQ(net_pressure({.acceleration = 700}), 700);
  EXPECT_EQ(net_pressure({.tension = 300}), -300);
  EXPECT_EQ(net_pressure({.atmosphere = 50}), -50);
  EXPECT_EQ(net_pressure({.compression = 4000}), -4000);
  EXPECT_EQ(net_pressure({12000, 700, 300, 50, 4000}), 12000 + 700 - 300 - 50 - 4000);
}

TEST(NetPressure, IsWhatTheHeartHasOverTheOutside) {
  const PressureParts p{12000, 700, 300, 50, 4000};
  EXPECT_EQ(net_pressure(p), p.heart - p.outside());
}

TEST(Compression, ActsBetweenItsPlanes) {
  Parameters p;
  p.compression = 5000;
  p.compression_axis = Axis::z;
  EXPECT_EQ(compression(p).at({9, 9, -1e3}), 5000);  // everywhere
  p.compression_from = -0.1;
  p.compression_to = 0.2;
  const Compression cuff = compression(p);
  EXPECT_EQ(cuff.at({9, 9, -0.1}), 5000);
  EXPECT_EQ(cuff.at({0, 0, 0.2}), 5000);
  EXPECT_EQ(cuff.at({0, 0, 0.21}), 0);
  EXPECT_EQ(cuff.at({0, 0, -0.11}), 0);
}

}  // namespace
}  // namespace rhexis::coupling
