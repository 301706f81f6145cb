// SPDX-License-Identifier: BSD-3-Clause
#include "output/unfinished_run.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "output/results_folder.hpp"
#include "output/run_record.hpp"
#include "temporary_directory.hpp"

namespace rhexis {
namespace {

using State = output::UnfinishedRun::State;

const parallel::Communicator world = parallel::Communicator::world();

TEST(UnfinishedRun, IsAtWorkAsLongAsItsFolderIsLockedAndThenDead) {
  const test::TemporaryDirectory directory;
  EXPECT_FALSE(output::unfinished_run(directory.path()));
  std::optional<output::ResultsFolder> held;
  held.emplace(output::FolderPlan{.directory = directory.path()}, world);
  { const output::RunRecord record(directory / "run.json", {}, nullptr, nullptr, nullptr, world); }
  ASSERT_TRUE(output::unfinished_run(directory.path()));
  EXPECT_EQ(output::unfinished_run(directory.path())->state, State::at_work);
  world.barrier();
  held.reset();
  world.barrier();
  const auto dead = output::unfinished_run(directory.path());
  EXPECT_EQ(dead->state, State::dead);
  EXPECT_TRUE(dead->last_checkpoint.empty());
  EXPECT_FALSE(dead->holds_samples);
}

TEST(UnfinishedRun, ItsLastCheckpointIsTheOneOfTheLastStep) {
  const test::TemporaryDirectory directory;
  if (world.is_root()) {
    std::filesystem::create_directory(directory / "checkpoints");
    for (const char* name : {"step_999999.h5", "step_1000000.h5", "step_2000000.h5.part", "step_.h5",
                             "other_9000000.h5", "step_x.h5"})
      std::ofstream(directory / "checkpoints" / name);
    std::ofstream(directory / "run.json") << R"({"status": "running"})";
    std::ofstream(directory / "samples.csv");
  }
  world.barrier();
  const auto run = output::unfinished_run(directory.path());
  EXPECT_EQ(run->last_checkpoint.filename(), "step_1000000.h5");
  EXPECT_TRUE(run->holds_samples);
}

TEST(UnfinishedRun, ThereIsNoneThatHasToldItsEnd) {
  const test::TemporaryDirectory directory;
  for (const std::string status : {"completed", "failed: interrupted"}) {
    if (world.is_root()) std::ofstream(directory / "run.json") << R"({"status": ")" << status << "\"}";
    world.barrier();
    EXPECT_FALSE(output::unfinished_run(directory.path()));
    world.barrier();
  }
}

}  // namespace
}  // namespace rhexis
