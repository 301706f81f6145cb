// SPDX-License-Identifier: BSD-3-Clause
#include "output/parameters.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"

namespace rhexis::output {
namespace {

using Steps = std::vector<long>;

TEST(PlannedSteps, EverySoManySteps) {
  Parameters p;
  p.every_steps = 40;
  EXPECT_EQ(planned_steps(p, 100, 1e-6), (Steps{0, 40, 80, 100}));
  EXPECT_EQ(planned_steps(p, 80, 1e-6), (Steps{0, 40, 80}));
  EXPECT_EQ(planned_steps(p, 1, 1e-6), (Steps{0, 1}));
}

TEST(PlannedSteps, EverySoMuchTime) {
  Parameters p;
  p.every_time = 2.5e-6;  // falls between steps: the first step at or after it
  EXPECT_EQ(planned_steps(p, 8, 1e-6), (Steps{0, 3, 5, 8}));
  p.every_time = 1e15;
  EXPECT_EQ(planned_steps(p, 8, 1e-6), (Steps{0, 8}));
  p.every_time = 1e-7;  // finer than the steps: every step, once
  EXPECT_EQ(planned_steps(p, 3, 1e-6), (Steps{0, 1, 2, 3}));
}

TEST(PlannedSteps, ByThemselvesAboutNinety) {
  const Steps plan = planned_steps(Parameters{}, 4500, 1e-6);
  EXPECT_EQ(plan.size(), 91u);
  EXPECT_EQ(plan.back(), 4500);
}

TEST(PlannedSteps, MoreThanAnybodyWantsAreRefused) {
  Parameters p;
  p.every_time = 1e-15;
  EXPECT_THROW(planned_steps(p, 100, 1e-6), InputError);
  p.every_time.reset();
  p.every_steps = 1;
  EXPECT_THROW(planned_steps(p, 1'000'000'000, 1e-6), InputError);
}

TEST(PlannedSteps, BothIntervalsAreRefused) {
  Parameters p;
  p.every_steps = 1;
  p.every_time = 1e-6;
  EXPECT_THROW(planned_steps(p, 10, 1e-6), InputError);
}

}  // namespace
}  // namespace rhexis::output
