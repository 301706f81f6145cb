// SPDX-License-Identifier: BSD-3-Clause
/// A disk that a test can fill.
#pragma once

#include <sys/mount.h>

#include <filesystem>
#include <string>

#include "parallel/communicator.hpp"

namespace rhexis::test {

/// A file system of its own with little space, mounted at `path` while it lives; not where the user may not
/// mount.
class SmallDisk {
 public:
  SmallDisk(const std::filesystem::path& path, std::int64_t bytes) : path_(path) {
    if (world_.is_root())
      mounted_ = mount("none", path.c_str(), "tmpfs", 0, ("size=" + std::to_string(bytes)).c_str()) == 0;
    mounted_ = world_.all_reduce(std::int64_t{mounted_}, parallel::Reduce::max) == 1;
  }
  ~SmallDisk() {
    world_.barrier();
    if (mounted_ && world_.is_root()) umount2(path_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  bool mounted() const { return mounted_; }

 private:
  parallel::Communicator world_ = parallel::Communicator::world();
  std::filesystem::path path_;
  bool mounted_ = false;
};

}  // namespace rhexis::test
