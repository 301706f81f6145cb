#pragma once

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "core/error.hpp"

namespace rhexis {

/// The whole of a file. Throws InputError where it cannot be read to its end.
inline std::string whole_file(const std::filesystem::path& path) {
  const auto fail = [&](int reason) {
    throw InputError(path.string() + ": cannot be read: " + std::strerror(reason));
  };
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) fail(EISDIR);
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail(errno);
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream.bad()) fail(errno != 0 ? errno : EIO);
  return text;
}

}  // namespace rhexis
