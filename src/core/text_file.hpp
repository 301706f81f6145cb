// SPDX-License-Identifier: BSD-3-Clause
/// Files of text that are read whole: regular ones, that fit into memory.
#pragma once

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

#include "core/error.hpp"
#include "core/format.hpp"
#include "core/memory.hpp"

namespace rhexis {

/// Throws InputError where `path` is anything but a regular file (or a link to one): to read a pipe waits for
/// ever, and a device may have no end.
inline void require_regular_file(const std::filesystem::path& path) {
  const auto fail = [&](const std::string& reason) {
    throw InputError(path.string() + ": cannot be read: " + reason);
  };
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) fail(std::strerror(error ? error.value() : ENOENT));
  if (std::filesystem::is_directory(status)) fail(std::strerror(EISDIR));
  if (!std::filesystem::is_regular_file(status)) fail("a pipe, socket or device, and no regular file");
}

/// The whole of a file. Throws InputError where it is no regular one, cannot be read to its end, or has more
/// than `most` bytes, or than there is memory for; `why` goes on after the size of one with more than `most`.
inline std::string whole_file(const std::filesystem::path& path,
                              std::uintmax_t most = std::numeric_limits<std::uintmax_t>::max(),
                              const std::string& why = "") {
  const auto fail = [&](const std::string& reason) { throw InputError(path.string() + ": " + reason); };
  require_regular_file(path);
  std::error_code ignored;
  const std::uintmax_t bytes = std::filesystem::file_size(path, ignored);
  const std::string has = "has " + quantity(static_cast<double>(bytes), "B");
  if (bytes > most) fail(has + why);
  const MemoryLimit memory = available_memory();
  if (static_cast<double>(bytes) > memory.bytes)
    fail(has + ", and there is memory for " + quantity(memory.bytes, "B") + " (" + memory.source + ")");
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail(std::string("cannot be read: ") + std::strerror(errno));
  try {
    std::string text;
    text.reserve(static_cast<std::size_t>(bytes));
    text.assign(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    if (stream.bad()) fail(std::string("cannot be read: ") + std::strerror(errno != 0 ? errno : EIO));
    return text;
  } catch (const std::bad_alloc&) {
    fail(has + ", and there is no memory for them");
  }
  return {};
}

}  // namespace rhexis
