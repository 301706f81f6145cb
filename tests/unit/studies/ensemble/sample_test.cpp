// SPDX-License-Identifier: BSD-3-Clause
#include "studies/ensemble/sample.hpp"

#include <gtest/gtest.h>

#include "support/weak_vessel.hpp"

namespace rhexis::ensemble {
namespace {

const peridynamics::WallModel& weak_wall() {
  static const peridynamics::SharedWall wall = peridynamics::make_wall(test::weak_vessel());
  return *wall;
}

const auto never = [] { return false; };

TEST(Sample, EndsAtTheOnsetOrAtTheEnd) {
  const Parameters p{.samples = 1};
  std::int64_t bonds = 0;
  const auto high = simulate(p, weak_wall(), 40e3, 0, never, bonds);
  ASSERT_TRUE(high && high->ruptured && high->onset && high->first_break);
  EXPECT_LE(*high->first_break, *high->onset);
  EXPECT_LT(*high->onset, 5e-4);
  EXPECT_GT(high->max_displacement, 0);
  EXPECT_GT(bonds, 0);
  const auto low = simulate(p, weak_wall(), 2e3, 0, never, bonds);
  ASSERT_TRUE(low);
  EXPECT_FALSE(low->ruptured || low->onset || low->first_break);
  EXPECT_LT(high->steps, low->steps);
  // The same again.
  EXPECT_EQ(*simulate(p, weak_wall(), 40e3, 0, never, bonds), *high);
}

TEST(Sample, StrongerWallsHoldLonger) {
  const Parameters p{.samples = 40, .seed = 1, .strength_spread = 0.2};
  std::int64_t weakest = 0, strongest = 0, bonds = 0;
  for (std::int64_t i = 1; i < p.samples; ++i) {
    if (draw_wall(p, i).strength < draw_wall(p, weakest).strength) weakest = i;
    if (draw_wall(p, i).strength > draw_wall(p, strongest).strength) strongest = i;
  }
  const auto weak = simulate(p, weak_wall(), 60e3, weakest, never, bonds);
  const auto strong = simulate(p, weak_wall(), 60e3, strongest, never, bonds);
  ASSERT_TRUE(weak->ruptured && strong->ruptured);
  EXPECT_LT(*weak->onset, *strong->onset);
}

TEST(Sample, StopsWhenAsked) {
  int asked = 0;
  std::int64_t bonds = 0;
  EXPECT_FALSE(simulate(
      {.samples = 1}, weak_wall(), 2e3, 0, [&] { return ++asked == 3; }, bonds));
  EXPECT_EQ(asked, 3);
}

}  // namespace
}  // namespace rhexis::ensemble
