// SPDX-License-Identifier: BSD-3-Clause
#include "output/file_identity.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/error.hpp"

namespace rhexis::output {

FileIdentity::FileIdentity(std::filesystem::path path) : path_(std::move(path)) {
  struct stat now = {};
  if (stat(path_.c_str(), &now) != 0)
    throw RunError(fmt::format("{}: cannot be found: {}", path_.string(), std::strerror(errno)));
  device_ = now.st_dev;
  inode_ = now.st_ino;
}

void FileIdentity::require_unchanged() const {
  struct stat now = {};
  if (stat(path_.c_str(), &now) != 0) {
    throw RunError(fmt::format("{}: has been taken away while the run was writing to it ({})", path_.string(),
                               std::strerror(errno)));
  }
  if (now.st_dev != device_ || now.st_ino != inode_) {
    throw RunError(
        fmt::format("{}: has been replaced by another while the run was writing to it", path_.string()));
  }
}

}  // namespace rhexis::output
