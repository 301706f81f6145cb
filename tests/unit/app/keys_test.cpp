// SPDX-License-Identifier: BSD-3-Clause
// The keys of the whole program, which the folders declare apart from each other, against each other; and
// what is said of keys that a scene leaves without effect.
#include <gtest/gtest.h>

#include "app/scene_keys.hpp"
#include "input/catalogue.hpp"
#include "input/document.hpp"
#include "input/values.hpp"
#include "unit/app/scene_texts.hpp"

namespace rhexis::app {
namespace {

/// The warnings of an input of this text.
std::vector<std::string> warnings_of(const std::string& text,
                                     const std::vector<std::string>& overrides = {}) {
  return input_of(test::read_scene(text, overrides)).warnings;
}

std::vector<std::string> warnings_of_input(const std::string& name, const std::string& override) {
  return input_of(test::read_file("inputs/" + name, {override})).warnings;
}

/// One warning, of `key` and with `why`.
void expect_no_effect(const std::vector<std::string>& warnings, const std::string& key,
                      const std::string& why) {
  ASSERT_EQ(warnings.size(), 1u) << key << (warnings.empty() ? "" : "\n" + warnings.back());
  EXPECT_NE(warnings.front().find(key), std::string::npos) << warnings.front();
  EXPECT_NE(warnings.front().find("has no effect"), std::string::npos) << warnings.front();
  EXPECT_NE(warnings.front().find(why), std::string::npos) << warnings.front();
}

TEST(Keys, DependOnOthersThatThereAreAndValuesThatTheseTake) {
  const AllKeys keys;
  const ParameterList& all = keys.list();
  int dependent = 0;
  for (const Parameter& parameter : all) {
    dependent += parameter.only_with.empty() ? 0 : 1;
    for (const Condition& condition : parameter.only_with) {
      const Parameter* other = input::find(all, condition.key);
      ASSERT_NE(other, nullptr) << parameter.key << ": " << condition.key;
      for (const std::string& value : condition.values)
        EXPECT_NO_THROW(input::store(input::parse_value(value), *other)) << parameter.key << ": " << value;
    }
  }
  EXPECT_GT(dependent, 30);
}

TEST(Keys, TakeTheirOwnDefaultsAsTheyAreShown) {
  const AllKeys keys;
  const ParameterList& all = keys.list();
  for (const Parameter& parameter : all) {
    if (parameter.required || input::is_repeated(parameter)) continue;
    const input::Value shown = input::default_value(parameter);
    EXPECT_NO_THROW(input::store(shown, parameter)) << parameter.key;
    EXPECT_EQ(written(input::default_value(parameter)), written(shown)) << parameter.key;
  }
}

TEST(Keys, ThatHaveAnEffectAreNotWarnedOf) {
  EXPECT_EQ(warnings_of(test::vessel), std::vector<std::string>{});
  EXPECT_EQ(warnings_of(test::tree), std::vector<std::string>{});
  EXPECT_EQ(warnings_of(test::vessel, {"scatter.stiffness=0.1", "scatter.seed=3", "scatter.law=weibull",
                                       "scatter.correlation_length=0.3 mm", "output.precision=double"}),
            std::vector<std::string>{});
  EXPECT_EQ(warnings_of(test::tree, {"network.tier=explicit", "network.solver=amg", "network.imbalance=1e-9",
                                     "network.max_iterations=50"}),
            std::vector<std::string>{});
  EXPECT_EQ(warnings_of(test::tree, {"network.shown_subtree=artery.01", "network.statistics=false"}),
            std::vector<std::string>{});
  EXPECT_EQ(
      warnings_of(test::tree, {"weakness.subtrees=[\"artery.01\"]", "weakness.strength=0.3",
                               "weakness.thickness=0.8", "weakness.thickness_spread=0.1", "weakness.seed=2"}),
      std::vector<std::string>{});
}

TEST(Keys, WithoutEffectAreWarnedOf) {
  for (const char* key : {"scatter.seed=3", "scatter.law=weibull", "scatter.correlation_length=0.3 mm"})
    expect_no_effect(warnings_of(test::vessel, {key}), key,
                     "without scatter.critical_stretch or scatter.stiffness");
  expect_no_effect(warnings_of(test::vessel, {"output.precision=double", "output.fields=[]"}),
                   "output.precision", "without output.fields");
  for (const char* key : {"network.solver=amg", "network.imbalance=1e-9", "network.max_iterations=50"})
    expect_no_effect(
        warnings_of(test::tree, {key}), key,
        "where network.source = \"tree\" and network.tier = \"auto\", only with network.source = "
        "\"file\", or network.tier = \"explicit\" or \"distributed\"");
  for (const char* key : {"network.statistics=false", "network.shown_subtree=artery.01"})
    expect_no_effect(warnings_of(test::tree, {key, "network.tier=explicit"}), key, "only with \"implicit\"");
  for (const char* key : {"weakness.strength=0.3", "weakness.thickness=0.8"})
    expect_no_effect(warnings_of(test::tree, {key}), key, "without weakness.vessels or weakness.subtrees");
  expect_no_effect(warnings_of(test::tree, {"tree.length_by_radius=[[\"1 mm\",\"1 cm\"],[\"2 mm\",\"4 cm\"]]",
                                            "tree.length_ratio=30"}),
                   "tree.length_ratio", "where tree.length_by_radius is given");
  expect_no_effect(warnings_of(test::tree, {"weakness.seed=2"}), "weakness.seed",
                   "without weakness.strength_spread");
  expect_no_effect(warnings_of_input("own_network.toml", "network.statistics=false"), "network.statistics",
                   "files");
  expect_no_effect(warnings_of_input("two_way.toml", "load.supply_area=1 mm2"), "load.supply_area",
                   "the network supplies the blood");
}

TEST(Warnings, OfRampsThatAreNotOverAtTheEnd) {
  EXPECT_EQ(warnings_of(test::ensemble), std::vector<std::string>{});
  for (const auto& warnings : {warnings_of(test::ensemble, {"load.ramp_time=0.8 ms"}),
                               warnings_of_input("cascade.toml", "load.ramp_time=5 ms")}) {
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings.front().find("the ramp is not over at time.end: walls see "), std::string::npos)
        << warnings.front();
  }
  EXPECT_NE(warnings_of(test::ensemble, {"load.ramp_time=0.8 ms"}).front().find(" 50 % "), std::string::npos);
}

TEST(Warnings, OfALoadThatIsBeyondAll) {
  EXPECT_EQ(warnings_of(test::vessel), std::vector<std::string>{});
  const auto warnings = warnings_of(test::vessel, {"load.pressure=100 MPa"});
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings.front().find("check the units"), std::string::npos) << warnings.front();
}

TEST(Risk, IsThatOfLamesHoopStrainAtTheLumen) {
  const Configuration c = test::read_scene(test::vessel);
  const peridynamics::SharedWall wall = std::get<scenes::VesselScene>(c).wall;
  const peridynamics::Parameters& v = wall->parameters;
  const double hoop = (2.0 * 2.0 + 1.5 * 1.5) / (2.0 * 2.0 - 1.5 * 1.5);  // over the pressure
  EXPECT_NEAR(scenes::risk_of_load(v).value(), 1e5 * (hoop + 0.25) / v.young_modulus / *v.critical_stretch,
              1e-12);
}

TEST(Warnings, OfBloodThatRunsBackwards) {
  EXPECT_EQ(warnings_of(test::tree, {"flow.inlet_pressure=1 mmHg"}).size(), 1u);
}

}  // namespace
}  // namespace rhexis::app
