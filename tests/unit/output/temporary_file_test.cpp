// SPDX-License-Identifier: BSD-3-Clause
#include "output/temporary_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "core/error.hpp"
#include "output/atomic_file.hpp"
#include "temporary_directory.hpp"

namespace rhexis {
namespace {

namespace fs = std::filesystem;
using test::text_of;

// Local to a rank, so each rank has a folder of its own.
struct OwnFolder : test::TemporaryDirectory {
  OwnFolder() : own(path() / std::to_string(parallel::Communicator::world().rank())) {
    fs::create_directory(own);
  }
  fs::path own;
};

TEST(TemporaryFile, NamesAreNewAndTellTheRunThatMadeThem) {
  const fs::path first = output::temporary_name_beside("folder/run.json"),
                 second = output::temporary_name_beside("folder/run.json");
  EXPECT_NE(first, second);
  EXPECT_EQ(first.parent_path(), "folder");
  EXPECT_EQ(output::run_token().size(), 16);
  EXPECT_TRUE(output::is_temporary(first.filename().string(), output::run_token()));
  const std::string token = "0123456789abcdef";
  EXPECT_FALSE(output::is_temporary(first.filename().string(), token));
  EXPECT_TRUE(output::is_temporary(".x." + token + "-12", token));
  for (const std::string& name :
       {".x." + token, ".x." + token + "-", "x." + token + "-12", ".x" + token + "-12",
        ".x." + token + "-12.csv", std::string("12"), std::string()})
    EXPECT_FALSE(output::is_temporary(name, token)) << name;
  const fs::path longest = output::temporary_name_beside("folder/" + std::string(255, 'a'));
  EXPECT_EQ(longest.filename().string().size(), 255);
}

TEST(TemporaryFile, GoesUnlessItIsPutInPlace) {
  const OwnFolder folder;
  { const output::TemporaryFile gone(folder.own / "a"); }
  EXPECT_TRUE(fs::is_empty(folder.own));
  output::TemporaryFile kept(folder.own / "a");
  EXPECT_EQ(fs::file_size(kept.name()), 0);
  kept.put_in_place();
  EXPECT_TRUE(fs::exists(folder.own / "a") && !fs::exists(kept.name()));
  const mode_t mask = umask(0);
  umask(mask);
  struct stat status {};
  ASSERT_EQ(stat((folder.own / "a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0666 & ~mask);
}

TEST(TemporaryFile, ALinkIsReplacedAndNotFollowed) {
  const OwnFolder folder;
  output::write_atomically(folder.own / "victim", "secret");
  fs::create_symlink("victim", folder.own / "link");
  output::TableFile table(folder.own / "link", "header\n");
  table.append("row\n");
  EXPECT_EQ(text_of(folder.own / "victim"), "secret");
  EXPECT_EQ(text_of(folder.own / "link"), "header\nrow\n");
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(folder.own / "link")));
}

TEST(TemporaryFile, ErrorsNameTheFileItIsFor) {
  const std::string message =
      test::message_of<RunError>([] { output::temporary_beside("/proc/nowhere/run.json"); });
  EXPECT_EQ(message, "/proc/nowhere/run.json: cannot create the file: No such file or directory");
}

}  // namespace
}  // namespace rhexis
