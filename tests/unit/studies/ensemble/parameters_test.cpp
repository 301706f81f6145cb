// SPDX-License-Identifier: BSD-3-Clause
#include "studies/ensemble/parameters.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"

namespace rhexis::ensemble {
namespace {

std::string key_at_fault(Parameters p) {
  try {
    resolve(p);
  } catch (const InputError& error) {
    return error.key;
  }
  return "";
}

TEST(EnsembleParameters, PressuresAreSorted) {
  Parameters p{.pressures = {3e4, 1e4, 2e4}, .samples = 7};
  resolve(p);
  EXPECT_EQ(p.pressures, (std::vector<double>{1e4, 2e4, 3e4}));
  EXPECT_EQ(p.vessels(), 21);
}

TEST(EnsembleParameters, ARangeHasItsEndsExactly) {
  Parameters p{.lowest_pressure = 0.1, .highest_pressure = 0.7, .pressure_count = 4};
  resolve(p);
  ASSERT_EQ(p.pressures.size(), 4u);
  EXPECT_EQ(p.pressures.front(), 0.1);
  EXPECT_EQ(p.pressures.back(), 0.7);
  EXPECT_NEAR(p.pressures[1], 0.3, 1e-15);
}

TEST(EnsembleParameters, ExactlyOneWayToGivePressures) {
  EXPECT_EQ(key_at_fault({}), "ensemble.pressures");
  EXPECT_EQ(key_at_fault({.pressures = {1e4}, .pressure_count = 3}), "ensemble.pressures");
  EXPECT_EQ(key_at_fault({.pressures = {1e4, 2e4, 1e4}}), "ensemble.pressures");
  EXPECT_EQ(key_at_fault({.lowest_pressure = 1e4, .highest_pressure = 2e4}), "ensemble.pressure_count");
  EXPECT_EQ(key_at_fault({.highest_pressure = 2e4, .pressure_count = 3}), "ensemble.lowest_pressure");
  EXPECT_EQ(key_at_fault({.lowest_pressure = 1e4, .pressure_count = 3}), "ensemble.highest_pressure");
  EXPECT_EQ(key_at_fault({.lowest_pressure = 2e4, .highest_pressure = 2e4, .pressure_count = 3}),
            "ensemble.highest_pressure");
  EXPECT_EQ(key_at_fault({.pressures = {1e4, 2e4}, .samples = 5'000'001}), "ensemble.samples");
}

}  // namespace
}  // namespace rhexis::ensemble
