// SPDX-License-Identifier: BSD-3-Clause
// The names and their order in run.json are what users' scripts rely on.
#include "scenes/results.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "runtime/performance.hpp"

namespace rhexis::scenes {
namespace {

using Json = nlohmann::ordered_json;

void expect_keys(const Json& object, const std::string& names) {
  std::istringstream words(names);
  std::string word;
  for (const auto& [key, value] : object.items()) {
    ASSERT_TRUE(words >> word) << key;
    EXPECT_EQ(key, word);
    EXPECT_TRUE(value.is_null() || key == "network");
  }
  EXPECT_FALSE(words >> word) << word;
}

TEST(Results, HaveAllNamesFromTheFirstMomentOn) {
  const Json results = Results{};
  expect_keys(
      results,
      "particles bonds family_max time_step_s stable_time_step_s steps simulated_s first_bond_break_s "
      "rupture_onset_s pressure_at_onset_Pa blood_pressure_at_onset_Pa max_displacement_at_onset_m "
      "max_displacement_m max_damage rupture_length_m opening_area_m2 energy_drift network coupling "
      "cascade ensemble");
  expect_keys(results["network"],
              "vessels junctions inflow_m3_s max_imbalance volume_m3 surface_m2 highest_reynolds "
              "highest_pressure_Pa lowest_pressure_Pa solver iterations queries screening survey");
}

TEST(Performance, HasAllNamesFromTheFirstMomentOn) {
  expect_keys(runtime::Performance{},
              "processor compiler ranks threads wall_s solve_s insitu_s output_s bond_evaluations "
              "bond_evaluations_per_s flop exchange_s exchange_bytes message_latency_s message_bandwidth_B_s "
              "peak_rss_bytes node_hours energy_J");
}

TEST(Results, KeepValues) {
  Results results{.particles = 54800, .max_damage = 0.1};
  results.network["vessels"] = 34'000'000'000;
  const Json json = results;
  EXPECT_EQ(json["particles"], 54800);
  EXPECT_EQ(json["max_damage"], 0.1);
  EXPECT_EQ(json["network"]["vessels"], 34'000'000'000);
}

}  // namespace
}  // namespace rhexis::scenes
