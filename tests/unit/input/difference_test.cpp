// SPDX-License-Identifier: BSD-3-Clause
// What two records of a configuration have different.
#include "input/difference.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "input/reader.hpp"
#include "sample_parameters.hpp"

namespace rhexis::input {
namespace {

nlohmann::ordered_json record_of(const std::vector<std::string>& overrides) {
  Sample sample;
  return to_json(
      read(parse_document("vessel.inner_radius = \"1 mm\"", "a.toml", overrides), sample.parameters()));
}

std::vector<std::string> texts(const std::vector<Difference>& differences) {
  std::vector<std::string> all;
  for (const Difference& d : differences) all.push_back(d.text);
  return all;
}

bool any(const std::string&) {
  return true;
}

TEST(Difference, IsOfValuesNotOfHowTheyAreWritten) {
  const auto written = record_of({"vessel.length=20 mm"}), differently = record_of({"vessel.length=2 cm"});
  EXPECT_TRUE(differences(written, differently, any).empty());
}

TEST(Difference, EveryKeyWithBothValues) {
  const auto earlier = record_of({}), now = record_of({"vessel.length=10 mm", "time.step=2 ns"});
  EXPECT_EQ(texts(differences(earlier, now, any)),
            (std::vector<std::string>{R"(vessel.length was "20 mm", and now is "10 mm")",
                                      R"(time.step was "auto", and now is "2 ns")"}));
  const auto of_time = [](const std::string& key) { return key == "time.step"; };
  const auto found = differences(earlier, now, of_time);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].key, "time.step");
}

TEST(Difference, KeysThatOneHasAndTheOtherNot) {
  auto earlier = record_of({}), now = earlier;
  now["spot[1]"]["radius"] = {{"written", "1 mm"}, {"value", 1e-3}};
  EXPECT_EQ(texts(differences(earlier, now, any)),
            std::vector<std::string>{R"(spot[1].radius was not there, and now is "1 mm")"});
  EXPECT_EQ(texts(differences(now, earlier, any)),
            std::vector<std::string>{R"(spot[1].radius was "1 mm", and now is not there)"});
}

}  // namespace
}  // namespace rhexis::input
