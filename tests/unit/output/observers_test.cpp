// SPDX-License-Identifier: BSD-3-Clause
// Observers that know no physics.
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "output/checkpoint_observer.hpp"
#include "output/field_observer.hpp"
#include "stored_file.hpp"
#include "synthetic_source.hpp"
#include "temporary_directory.hpp"

namespace rhexis {
namespace {

using parallel::Communicator;

const Communicator world = Communicator::world();

TEST(FieldObserver, StoresThePlannedStepsAndTheEnd) {
  const test::TemporaryDirectory directory;
  test::SyntheticSource source(test::divided(3, 17, world, 1), 0);
  output::FieldObserver fields({.directory = directory.path(),
                                .title = "test",
                                .version = "1.2.3",
                                .fields = {test::SyntheticSource::infos[1]},
                                .steps = {0, 50, 100}},
                               source, source.positions(), world);
  EXPECT_TRUE(fields.wants({.step = 50}));
  EXPECT_FALSE(fields.wants({.step = 51}));
  const Moment ends{.step = 51, .last = true, .signal = 15};
  ASSERT_TRUE(fields.wants(ends));
  source.move_to(50);
  fields.observe({.step = 50});
  source.move_to(51);
  fields.observe(ends);
  fields.end(ends);
  const std::filesystem::path path = directory / "particles.h5";
  EXPECT_EQ(test::stored(path, "/damage/000050"), test::expected("damage", 1, 51, 50));
  EXPECT_EQ(test::stored(path, "/damage/unplanned"), test::expected("damage", 1, 51, 51));
}

/// Checkpoints that are only told of.
struct Told {
  std::vector<std::string> said = {};
  bool disk_is_full = false;
  output::CheckpointObserver observer{
      {.every = 10,
       .write =
           [this](long step) {
             if (disk_is_full) throw RunError("disk full");
             said.push_back("wrote " + std::to_string(step));
             return std::filesystem::path(std::to_string(step) + ".h5");
           },
       .interrupted =
           [this](int signal, const std::filesystem::path& path) {
             said.push_back("signal " + std::to_string(signal) + ", " + path.string());
           },
       .failed = [this](const std::filesystem::path& path) { said.push_back("failed, " + path.string()); },
       .warn = [this](const std::string& reason) { said.push_back(reason); }}};
};

TEST(CheckpointObserver, WritesEverySoManyStepsButNotAtTheFirstMoment) {
  Told told;
  told.observer.arrive({.step = 20, .first = true});
  for (long step = 21; step <= 40; ++step) told.observer.arrive({.step = step});
  EXPECT_EQ(told.said, (std::vector<std::string>{"wrote 30", "wrote 40"}));
}

TEST(CheckpointObserver, WritesAtASignalAndTellsWhere) {
  Told told;
  told.observer.arrive({.step = 7, .last = true, .signal = 15});
  EXPECT_EQ(told.said, (std::vector<std::string>{"wrote 7", "signal 15, 7.h5"}));
}

TEST(CheckpointObserver, SavesARunThatFailsWhereItCan) {
  Told told;
  told.observer.rescue({.step = 7});
  EXPECT_EQ(told.said, (std::vector<std::string>{"wrote 7", "failed, 7.h5"}));
  told.disk_is_full = true;
  told.observer.rescue({.step = 8});
  EXPECT_EQ(told.said.back(), "no checkpoint: disk full");
}

}  // namespace
}  // namespace rhexis
