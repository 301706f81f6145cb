// SPDX-License-Identifier: BSD-3-Clause
// What a vessel's wall is made of, and how its load runs along it.
#include "coupling/wall_segment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"

namespace rhexis::coupling {
namespace {

const VesselData paper{1.5e-3, 0.5e-3, 10e-3};  // Table 2, of 10 mm

double particles_of(const VesselData& v, const WallSegment& segment) {
  const double outer = v.radius + v.wall_thickness;
  return std::numbers::pi * (outer * outer - v.radius * v.radius) * segment.length /
         std::pow(segment.spacing, 3);
}

TEST(WallSegment, ConstantNumberOfParticles) {
  const WallSegment segment = choose_wall_segment(paper, 54973, false);
  EXPECT_TRUE(segment.whole);
  EXPECT_NEAR(segment.spacing, 100e-6, 0.1e-6);
  EXPECT_NEAR(particles_of(paper, segment), 54973, 1e-6);
  EXPECT_EQ(segment.start, 0);
  EXPECT_EQ(segment.length, paper.length);
}

TEST(WallSegment, IsShorterWhereTheRuleIsTooCoarse) {
  const VesselData aorta{12.5e-3, 1.5e-3, 0.4};
  const WallSegment paper_rule = choose_wall_segment(aorta, 55000, true),
                    segment = choose_wall_segment(aorta, 55000, false);
  EXPECT_LT(aorta.wall_thickness / paper_rule.spacing, 4);
  EXPECT_TRUE(paper_rule.whole);
  EXPECT_FALSE(segment.whole);
  EXPECT_NEAR(aorta.wall_thickness / segment.spacing, 5, 1e-12);
  EXPECT_NEAR(particles_of(aorta, segment), 55000, 1e-6);
  EXPECT_NEAR(segment.start + segment.length / 2, aorta.length / 2, 1e-15);
  EXPECT_EQ(segment.paper_spacing, paper_rule.spacing);
}

TEST(WallSegment, ClampedEndsHoldTheWallBackThatFar) {
  // The deflection of a beam on an elastic foundation, over that far from its end.
  const double radius = 1.5e-3, wall = 0.15e-3, nu = 0.25, reach = clamped_reach(radius, wall, nu);
  const double beta = std::pow(3 * (1 - nu * nu), 0.25) / std::sqrt(radius * wall);
  const auto deflection = [=](double x) {
    return 1 - std::exp(-beta * x) * (std::sin(beta * x) + std::cos(beta * x));
  };
  for (double x = reach; x < 5 * reach; x += 0.01 * reach) EXPECT_NEAR(deflection(x), 1, 0.05) << x;
  EXPECT_LT(deflection(0.5 * reach), 0.9);
}

TEST(WallSegment, TooFewRows) {
  EXPECT_THROW(choose_wall_segment({1.5e-3, 0.5e-3, 0.2e-3}, 55000, false), InputError);  // a ring
  const VesselData film{12.5e-3, 0.1e-3, 0.4};
  try {
    choose_wall_segment(film, 55000, false);
    ADD_FAILURE();
  } catch (const InputError& error) {
    const std::string message = error.what();
    const std::size_t at = message.find("take ");
    ASSERT_NE(at, std::string::npos) << message;
    const long enough = std::stol(message.substr(at + 5));
    EXPECT_NO_THROW(choose_wall_segment(film, enough, false)) << message;
    EXPECT_THROW(choose_wall_segment(film, enough - 1, false), InputError) << message;
  }
}

TEST(WallSegment, KeepsTheUsersSpacing) {
  peridynamics::Parameters p;
  p.spacing = 80e-6;
  const WallSegment segment = extract_wall_segment(paper, false, p);
  EXPECT_TRUE(segment.whole);
  EXPECT_EQ(p.spacing, 80e-6);
  EXPECT_EQ(p.inner_radius, 1.5e-3);
  EXPECT_EQ(p.outer_radius, 2e-3);
  EXPECT_EQ(p.length, 10e-3);
}

TEST(AxialProfile, IsOneToTheLastBitUnderUniformLoad) {
  const double p = 12345.678901;
  const WallSegment segment = choose_wall_segment(paper, 55000, false);
  const auto profile = axial_profile({{p, p, p}}, paper, segment);
  for (int row = 0; row < 97; ++row) EXPECT_EQ(profile((row + 0.5) * segment.spacing), 1.0);
}

TEST(AxialProfile, IsLinearBetweenEndsAndMiddle) {
  const AxialLoad load{{400, 200, 100}};
  EXPECT_EQ(load.at(0), 400);
  EXPECT_EQ(load.at(0.25), 300);
  EXPECT_EQ(load.at(0.5), 200);
  EXPECT_EQ(load.at(0.75), 150);
  EXPECT_EQ(load.at(1), 100);
  WallSegment segment;
  segment.start = 2e-3;
  segment.length = 6e-3;
  const auto profile = axial_profile(load, paper, segment);
  // The load on the segment itself, which ends at 2 and 8 of 10 mm.
  EXPECT_NEAR(largest_load(load, paper, segment), 320, 1e-12);
  EXPECT_NEAR(profile(0.5e-3), 300.0 / 320, 1e-15);  // at 2.5 mm
  EXPECT_NEAR(profile(5.5e-3), 150.0 / 320, 1e-15);  // at 7.5 mm
  EXPECT_EQ(largest_load({{100, 500, 0}}, paper, segment), 500);
}

}  // namespace
}  // namespace rhexis::coupling
