// SPDX-License-Identifier: BSD-3-Clause
#include "output/staging_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "core/error.hpp"
#include "temporary_directory.hpp"

namespace rhexis {
namespace {

namespace fs = std::filesystem;
using output::ResultsFolder;
using output::StagingFolder;
using test::text_of;

const parallel::Communicator world = parallel::Communicator::world();

class Staging : public ::testing::Test {
 protected:
  Staging() { start({.directory = {}}); }

  void start(output::FolderPlan plan) {
    staging_.reset();
    folder_.reset();
    world.barrier();
    plan.directory = directory_ / "r";
    folder_.emplace(plan, world);
    folder_->remove_earlier_results();
    staging_.emplace(*folder_, "images", world);
    EXPECT_FALSE(fs::exists(staging_->path()));
    staging_->deliver("nobody", 0);
    world.barrier();
    staging_->open();
  }

  /// As a script of one rank does.
  void write(const fs::path& path, const std::string& text, std::ios::openmode mode = std::ios::out) {
    world.barrier();
    if (world.rank() == world.size() - 1) {
      fs::create_directories(path.parent_path());
      std::ofstream(path, mode) << text;
      // Clocks of file systems are coarse.
      fs::last_write_time(path, fs::file_time_type(std::chrono::seconds(++clock_)));
    }
    world.barrier();
  }

  std::string image(const std::string& name) {
    world.barrier();
    const std::string text = text_of(directory_ / ("r/images/" + name));
    world.barrier();
    return text;
  }

  std::string failure_of_delivery(const std::string& author, long step) {
    return test::message_of<RunError>([&] { staging_->deliver(author, step); });
  }

  test::TemporaryDirectory directory_;
  std::optional<ResultsFolder> folder_;
  std::optional<StagingFolder> staging_;
  int clock_ = 1000;
};

TEST_F(Staging, FilesAppearWhenTheyAreDeliveredAndStayReadable) {
  const fs::path path = staging_->path();
  EXPECT_TRUE(path.is_absolute());
  write(path / "a_001.png", "one");
  write(path / "deeper/table.csv", "row\n");
  EXPECT_EQ(image("a_001.png"), "");
  staging_->deliver("a.py", 1);
  EXPECT_EQ(image("a_001.png") + image("deeper/table.csv"), "onerow\n");
  EXPECT_EQ(text_of(path / "a_001.png"), "one");
  write(path / "deeper/table.csv", "row\n", std::ios::app);
  EXPECT_EQ(image("deeper/table.csv"), "row\n");
  staging_->deliver("a.py", 2);
  EXPECT_EQ(image("deeper/table.csv"), "row\nrow\n");
  write(path / "a_001.png", "again");
  staging_->deliver("a.py", 3);
  EXPECT_EQ(image("a_001.png"), "again");
  staging_.reset();
  world.barrier();
  EXPECT_FALSE(fs::exists(path));
  EXPECT_EQ(std::distance(fs::recursive_directory_iterator(directory_ / "r/images"), {}), 3);
}

TEST_F(Staging, OneNameByTwoAuthorsAtOneStepIsAnErrorThatNamesBoth) {
  write(staging_->path() / "a_001.png", "one");
  staging_->deliver("a.py", 1);
  staging_->deliver("b.py", 1);
  write(staging_->path() / "a_001.png", "two");
  EXPECT_EQ(failure_of_delivery("b.py", 1),
            "a.py and b.py both write images/a_001.png at step 1; give one of the files another name");
}

TEST_F(Staging, AFileOfTheUserIsNotReplaced) {
  write(directory_ / "r/images/a_001.png", "mine");
  write(staging_->path() / "a_001.png", "one");
  const std::string message = failure_of_delivery("a.py", 1);
  EXPECT_EQ(message.find("a.py: cannot write results to "), 0) << message;
  EXPECT_NE(message.find("images/a_001.png would be replaced"), std::string::npos) << message;
  EXPECT_EQ(image("a_001.png"), "mine");
}

TEST_F(Staging, ARestartGoesOnWithItsFiles) {
  write(staging_->path() / "a_001.png", "one");
  write(staging_->path() / "deeper/table.csv", "row\n");
  write(directory_ / "r/images/mine.png", "mine");
  staging_->deliver("a.py", 1);
  start({.directory = {}, .earlier = output::EarlierResults::keep});
  EXPECT_EQ(text_of(staging_->path() / "a_001.png"), "one");
  EXPECT_FALSE(fs::exists(staging_->path() / "mine.png"));
  write(staging_->path() / "deeper/table.csv", "row\n", std::ios::app);
  EXPECT_EQ(image("deeper/table.csv"), "row\n");
  staging_->deliver("a.py", 2);
  EXPECT_EQ(image("deeper/table.csv"), "row\nrow\n");
}

}  // namespace
}  // namespace rhexis
