// SPDX-License-Identifier: BSD-3-Clause
// Which scene an input file describes, what is said of keys that are not that scene's, and what a run of it
// would do to its folder.
#include "app/configuration.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "scenes/coupled/coupled_files.hpp"
#include "scenes/vessel/vessel_files.hpp"
#include "unit/app/scene_texts.hpp"

namespace rhexis::app {
namespace {

using test::read_scene;

std::string error_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return test::message_of<InputError>([&] { read_scene(text, overrides); });
}

testing::AssertionResult contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "no '" << part << "' in: " << text;
}

TEST(Scene, IsThatOfItsModel) {
  EXPECT_TRUE(std::holds_alternative<scenes::VesselScene>(read_scene(test::vessel)));
  EXPECT_TRUE(std::holds_alternative<scenes::NetworkScene>(read_scene(test::tree)));
  EXPECT_TRUE(std::holds_alternative<scenes::EnsembleScene>(read_scene(test::ensemble)));
  EXPECT_TRUE(std::holds_alternative<scenes::CoupledScene>(
      test::read_file("inputs/two_way.toml", {"insitu.enabled=false"})));
}

TEST(Scene, HasItsWallWhereThatIsKnownBeforeTheRun) {
  EXPECT_NE(wall_of(read_scene(test::vessel)), nullptr);
  EXPECT_NE(wall_of(read_scene(test::ensemble)), nullptr);
  EXPECT_EQ(wall_of(read_scene(test::tree)), nullptr);
  EXPECT_EQ(wall_of(test::read_file("inputs/two_way.toml", {"insitu.enabled=false"})), nullptr);
}

TEST(Scene, OfNoKnownModelIsRefused) {
  EXPECT_TRUE(contains(
      error_of(test::vessel, {"scene.model=vesel"}),
      R"(scene.model=vesel: not one of the choices; did you mean "vessel"? (allowed: "vessel", "network",)"));
}

TEST(Scene, RefusesKeysOfOthersWithTheirModels) {
  EXPECT_TRUE(contains(error_of(test::vessel, {"tree.generations=8"}),
                       R"(section [tree] belongs to scenes with scene.model = "network", "coupled")"));
  EXPECT_TRUE(
      contains(error_of(test::tree, {"output.every_steps=8"}),
               R"(this key belongs to scenes with scene.model = "vessel", "coupled"; this scene's is )"
               R"("network")"));
  EXPECT_TRUE(contains(error_of(test::vessel, {"vessel.lenght=8 mm"}), "vessel.length"));
}

TEST(Scene, OfACoupledVesselRefusesWhatTheOtherSideSays) {
  const auto refusal = [](const std::string& setting) {
    return test::message_of<InputError>([&] { test::read_file("inputs/two_way.toml", {setting}); });
  };
  EXPECT_TRUE(contains(refusal("load.pressure=1 kPa"), "the network says this of a coupled vessel"));
  EXPECT_TRUE(contains(refusal("wall.young_modulus=1 MPa"), "[material] says this of a coupled network"));
}

TEST(Scene, TellsWhereAValueStandsThatDoesNotFit) {
  EXPECT_TRUE(contains(error_of(test::vessel, {"vessel.outer_radius=1 mm"}),
                       "--set vessel.outer_radius=1 mm: the outer radius must be above the inner one"));
  std::string text = test::vessel;
  text.replace(text.find("2 mm"), 4, "1 mm");
  EXPECT_TRUE(contains(error_of(text), "scene.toml:4: vessel.outer_radius = \"1 mm\""));
}

bool writes(const output::FolderPlan& plan, const std::string& name) {
  return std::ranges::find(plan.writes.names, name) != plan.writes.names.end();
}

TEST(FolderPlan, OfAVesselNamesWhatItWrites) {
  const auto scene = std::get<scenes::VesselScene>(
      read_scene(test::vessel, {"output.checkpoint_every=5", "insitu.enabled=false"}));
  const long last = scene.wall->time.count;
  const output::FolderPlan plan = scenes::folder_plan(scene, {.directory = "there", .restart = {}});
  EXPECT_EQ(plan.directory, "there");
  EXPECT_EQ(plan.earlier, output::EarlierResults::remove);
  EXPECT_TRUE(writes(plan, "history.csv") && writes(plan, "run.json") && writes(plan, "particles.h5"));
  EXPECT_FALSE(writes(plan, "movie.mp4"));
  EXPECT_EQ(plan.reads.front(), scene.file);
  // An interrupt may ask for a checkpoint of any step, but of the first.
  EXPECT_TRUE(plan.writes.may_be_written(scenes::checkpoint_name(1)));
  EXPECT_TRUE(plan.writes.may_be_written(scenes::checkpoint_name(last)));
  EXPECT_FALSE(plan.writes.may_be_written(scenes::checkpoint_name(0)));
  EXPECT_FALSE(plan.writes.may_be_written(scenes::checkpoint_name(last + 1)));
  EXPECT_FALSE(plan.writes.may_be_written("checkpoints/step_1.h5"));
}

TEST(FolderPlan, OfARestartKeepsWhatIsThere) {
  const auto scene = std::get<scenes::VesselScene>(read_scene(test::vessel));
  const output::FolderPlan plan = scenes::folder_plan(scene, {.directory = "there", .restart = "a.h5"});
  EXPECT_EQ(plan.earlier, output::EarlierResults::keep);
  EXPECT_FALSE(writes(plan, "particles.h5"));
  EXPECT_EQ(plan.reads.back(), "a.h5");
  EXPECT_EQ(scenes::files_of_steps(scene.output, 40, 100, true).names.front(), "particles_from_000040.h5");
}

TEST(FolderPlan, OfANetworkDependsOnItsSolver) {
  const auto plan_of = [](const std::vector<std::string>& settings) {
    return scenes::folder_plan(std::get<scenes::NetworkScene>(read_scene(test::tree, settings)), {});
  };
  EXPECT_TRUE(writes(plan_of({}), "generations.csv"));
  EXPECT_FALSE(writes(plan_of({}), "vessels.csv"));
  EXPECT_TRUE(writes(plan_of({"network.tier=explicit"}), "vessels.csv"));
  EXPECT_FALSE(writes(plan_of({"network.tier=explicit"}), "generations.csv"));
  EXPECT_FALSE(writes(plan_of({}), "screening.csv"));
  EXPECT_TRUE(writes(plan_of({"screening.top=3"}), "screening.csv"));
}

TEST(FolderPlan, OfACascadeHasAFolderForEachEvent) {
  const auto scene = std::get<scenes::CoupledScene>(
      test::read_file("inputs/cascade.toml", {"cascade.events=2", "insitu.enabled=false"}));
  const output::FolderPlan plan = scenes::folder_plan(scene, {});
  EXPECT_TRUE(writes(plan, "cascade.csv") && writes(plan, "event_01/history.csv") &&
              writes(plan, "event_02/history.csv"));
  EXPECT_FALSE(writes(plan, "event_03/history.csv"));
  EXPECT_EQ(scenes::event_number("event_02/history.csv"), 2u);
  EXPECT_EQ(scenes::event_number("cascade.csv"), 0u);
}

}  // namespace
}  // namespace rhexis::app
