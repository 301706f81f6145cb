#include "output/atomic_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/error.hpp"

namespace rhexis::output {

void write_atomically(const std::filesystem::path& path, std::string_view text) {
  const std::filesystem::path temporary = path.string() + ".part";
  errno = 0;
  std::ofstream file(temporary, std::ios::binary);
  file << text;
  file.close();
  if (file && std::rename(temporary.c_str(), path.c_str()) == 0) return;

  const std::string reason = std::strerror(errno);
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  throw RunError(fmt::format("{}: cannot write the file: {}", path.string(), reason));
}

void cannot_write(const std::filesystem::path& path) {
  throw RunError(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
}

}  // namespace rhexis::output
