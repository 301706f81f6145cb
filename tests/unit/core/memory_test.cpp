// SPDX-License-Identifier: BSD-3-Clause
// What is left of memory by control groups, and files that are no files.
#include "core/memory.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "core/error.hpp"
#include "core/text_file.hpp"

namespace rhexis {
namespace {

namespace fs = std::filesystem;

class Folder : public testing::Test {
 protected:
  Folder() : root_(fs::temp_directory_path() / ("rhexis_core_" + std::to_string(getpid()))) {
    fs::create_directories(root_);
  }
  ~Folder() override { fs::remove_all(root_); }
  void write(const std::string& name, const std::string& text) {
    fs::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << text;
  }
  std::string error_of(const fs::path& file, std::uintmax_t most = 1000) const {
    try {
      whole_file(file, most, ", too much");
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
  fs::path root_;
};

using ControlGroups = Folder;

TEST_F(ControlGroups, NoneLeaveAll) {
  EXPECT_EQ(memory_of_control_groups(root_).bytes, std::numeric_limits<double>::infinity());
}

TEST_F(ControlGroups, TheTightestOfAllAboveCounts) {
  write("proc/self/cgroup", "0::/jobs/a\n");
  write("sys/fs/cgroup/jobs/a/memory.max", "max\n");
  write("sys/fs/cgroup/jobs/a/memory.current", "100\n");
  write("sys/fs/cgroup/jobs/memory.max", "5000\n");
  write("sys/fs/cgroup/jobs/memory.current", "3000\n");
  write("sys/fs/cgroup/jobs/memory.stat", "anon 1500\nfile 1500\ninactive_file 400\n");
  EXPECT_EQ(memory_of_control_groups(root_).bytes, 2400);
  EXPECT_NE(memory_of_control_groups(root_).source.find("/jobs"), std::string::npos);
}

TEST_F(ControlGroups, OfVersionOne) {
  write("proc/self/cgroup", "5:cpu,cpuacct:/x\n4:memory:/docker/b\n");
  write("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
  write("sys/fs/cgroup/memory/memory.usage_in_bytes", "1000\n");
  write("sys/fs/cgroup/memory/docker/b/memory.limit_in_bytes", "8000\n");
  write("sys/fs/cgroup/memory/docker/b/memory.usage_in_bytes", "7000\n");
  EXPECT_EQ(memory_of_control_groups(root_).bytes, 1000);
}

using WholeFile = Folder;

TEST_F(WholeFile, IsARegularOne) {
  write("a.txt", "some text");
  EXPECT_EQ(whole_file(root_ / "a.txt"), "some text");
  fs::create_symlink("a.txt", root_ / "link");
  EXPECT_EQ(whole_file(root_ / "link"), "some text");
  ASSERT_EQ(mkfifo((root_ / "pipe").c_str(), 0600), 0);
  EXPECT_NE(error_of(root_ / "pipe").find("no regular file"), std::string::npos);
  EXPECT_NE(error_of("/dev/zero").find("no regular file"), std::string::npos);
  EXPECT_NE(error_of(root_).find("directory"), std::string::npos);
  EXPECT_NE(error_of(root_ / "nowhere").find("No such file"), std::string::npos);
}

TEST_F(WholeFile, HasALimit) {
  write("a.txt", std::string(1001, 'a'));
  EXPECT_NE(error_of(root_ / "a.txt").find("1.001 kB, too much"), std::string::npos);
  write("huge.txt", "");
  fs::resize_file(root_ / "huge.txt", std::uintmax_t{1} << 43);  // sparse
  EXPECT_NE(error_of(root_ / "huge.txt", std::uintmax_t{1} << 50).find("there is memory for"),
            std::string::npos);
}

TEST(WithinMemory, NamesTheKey) {
  try {
    within_memory("the wall", "a.b", [] { throw std::bad_alloc(); });
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.key, "a.b");
    EXPECT_EQ(std::string(error.what()).rfind("the wall needs more memory than there is (", 0), 0u);
  }
}

}  // namespace
}  // namespace rhexis
