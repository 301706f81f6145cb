// SPDX-License-Identifier: BSD-3-Clause
#include "output/run_record.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.hpp"
#include "small_disk.hpp"
#include "temporary_directory.hpp"

namespace rhexis {
namespace {

using Json = nlohmann::ordered_json;
using output::RunRecord;

const parallel::Communicator world = parallel::Communicator::world();
/// Names whose values are not known yet.
const Json nothing{{"steps", nullptr}, {"wall_s", nullptr}};

std::vector<std::string> keys_of(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& item : object.items()) keys.push_back(item.key());
  return keys;
}

std::vector<std::string> words(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

TEST(RunRecord, HasAllKeysFromTheFirstMomentOn) {
  const test::TemporaryDirectory directory;
  RunRecord record(directory / "run.json", {.version = "0.1.0", .commit = "abc"},
                   {{"vessel", {{"length", 1.0}}}}, nothing, nothing, world);
  const Json json = Json::parse(test::text_of(directory / "run.json"));
  EXPECT_EQ(keys_of(json),
            words("version commit command started file checkpoint first_step input warnings status "
                  "results performance"));
  EXPECT_EQ(json["version"], "0.1.0");
  EXPECT_EQ(json["commit"], "abc");
  EXPECT_EQ(json["input"]["vessel"]["length"], 1.0);
  EXPECT_EQ(json["status"], "running");
  EXPECT_EQ(json["results"], nothing);
  EXPECT_EQ(json["performance"], nothing);
}

TEST(RunRecord, TellsHowTheRunEnded) {
  const test::TemporaryDirectory directory;
  RunRecord record(
      directory / "run.json",
      {.command = {"rhexis", "run", "a.toml"}, .checkpoint = "step_000150.h5", .first_step = 150}, nothing,
      nothing, nothing, world);
  record.warn("time.end is not a whole number of steps");
  record.complete({{"particles", 54800},
                   {"energy_drift", std::nan("")},
                   {"network", {{"vessels", 34'000'000'000}, {"solver", "tree"}}}},
                  {{"wall_s", 1.5}});
  Json json = Json::parse(test::text_of(directory / "run.json"));
  EXPECT_EQ(json["status"], "completed");
  EXPECT_EQ(json["command"], Json({"rhexis", "run", "a.toml"}));
  EXPECT_EQ(json["checkpoint"], "step_000150.h5");
  EXPECT_EQ(json["first_step"], 150);
  EXPECT_EQ(json["warnings"], Json({"time.end is not a whole number of steps"}));
  EXPECT_EQ(json["results"]["particles"], 54800);
  EXPECT_TRUE(json["results"]["energy_drift"].is_null());
  EXPECT_EQ(json["results"]["network"]["vessels"], 34'000'000'000);
  EXPECT_EQ(json["results"]["network"]["solver"], "tree");
  EXPECT_EQ(json["performance"]["wall_s"], 1.5);
  world.barrier();

  record.fail("disk full at \xff", nothing, nothing);
  json = Json::parse(test::text_of(directory / "run.json"));
  EXPECT_EQ(json["status"], "failed: disk full at \xEF\xBF\xBD");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(directory.path()), {}), 1);
}

TEST(RunRecord, TellsHowTheRunEndedOnAFullDisk) {
  const test::TemporaryDirectory directory;
  const test::SmallDisk disk(directory.path(), 256 * 1024);
  if (!disk.mounted()) GTEST_SKIP() << "mounting a small file system takes the superuser";
  RunRecord record(directory / "run.json", {}, nothing, nothing, nothing, world);
  if (world.is_root()) {
    std::ofstream all(directory / "all");
    while (all << std::string(4096, 'x') << std::flush) {
    }
  }
  world.barrier();
  record.fail("disk full", nothing, nothing);
  EXPECT_EQ(Json::parse(test::text_of(directory / "run.json"))["status"], "failed: disk full");
}

TEST(RunRecord, OneRankAloneMayTellHowTheRunEnded) {
  const test::TemporaryDirectory directory;
  RunRecord record(directory / "run.json", {.version = "0.1.0"}, nothing, nothing, nothing, world);
  if (world.rank() == world.size() - 1) record.fail_alone("out of memory");
  world.barrier();
  const Json json = Json::parse(test::text_of(directory / "run.json"));
  EXPECT_EQ(json["status"], "failed: out of memory");
  EXPECT_EQ(json["version"], "0.1.0");
  EXPECT_TRUE(json.contains("results") && json.contains("performance"));
  // The first reason stays, also when the first rank is asked to end because of it.
  if (world.size() > 1) {
    world.barrier();
    if (world.is_root()) record.fail_alone("interrupted");
    world.barrier();
    EXPECT_EQ(output::recorded_status(directory / "run.json"), "failed: out of memory");
  }
}

TEST(RunRecord, WhatIsKnownIsToldByAnEarlyEndButNothingAfterTheEnd) {
  const test::TemporaryDirectory directory;
  RunRecord record(directory / "run.json", {}, nothing, nothing, nothing, world);
  record.know({{"steps", 40}});
  for (const std::string reason : {"interrupted, and ended before its state was saved", "interrupted"}) {
    if (world.is_root()) record.fail_alone(reason);
    world.barrier();
    const Json json = Json::parse(test::text_of(directory / "run.json"));
    EXPECT_EQ(json["status"], "failed: " + reason);
    EXPECT_EQ(json["results"]["steps"], 40);
    world.barrier();
  }
  record.complete({{"steps", 80}}, nothing);
  if (world.is_root()) record.fail_alone("interrupted");
  world.barrier();
  EXPECT_EQ(output::recorded_status(directory / "run.json"), "completed");
}

TEST(RunRecord, AFolderOfAnotherRunIsLeftAlone) {
  const test::TemporaryDirectory directory;
  const auto folder = directory / "out";
  if (world.is_root()) std::filesystem::create_directory(folder);
  world.barrier();
  RunRecord record(folder / "run.json", {}, nothing, nothing, nothing, world);
  if (world.is_root()) {
    std::filesystem::rename(folder, directory / "moved");
    std::filesystem::create_directory(folder);
  }
  world.barrier();
  const std::string message = test::message_of<RunError>([&] { record.complete(nothing, nothing); });
  EXPECT_NE(message.find("out: has been replaced"), std::string::npos) << message;
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  EXPECT_EQ(output::recorded_status(directory / "moved/run.json"), "running");
}

TEST(RunRecord, AStatusIsReadFromWhateverIsThere) {
  const test::TemporaryDirectory directory;
  for (const std::string text : {"", "[]", "{\"status\": 1}", "{\"status\": \"run", "{}"}) {
    if (world.is_root()) std::ofstream(directory / "run.json") << text;
    world.barrier();
    EXPECT_EQ(output::recorded_status(directory / "run.json"), "");
    world.barrier();
  }
  EXPECT_EQ(output::recorded_status(directory / "none.json"), "");
}

TEST(RunRecord, AFolderThatIsNotThereIsARunErrorOnAllRanks) {
  const test::TemporaryDirectory directory;
  const std::string message = test::message_of<RunError>(
      [&] { RunRecord(directory / "no/run.json", {}, nothing, nothing, nothing, world); });
  EXPECT_NE(message.find("no/run.json: cannot create the file"), std::string::npos) << message;
}

}  // namespace
}  // namespace rhexis
