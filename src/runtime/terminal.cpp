// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/terminal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace rhexis::runtime {
namespace {

bool was_closed = false;  ///< stdout, by the caller
int output_error = 0;     ///< errno of the first failure

/// A failed write leaves nothing behind in the stream's buffer to be tried again.
bool write_all(std::FILE* stream, std::string_view text) {
  std::clearerr(stream);
  return std::fwrite(text.data(), 1, text.size(), stream) == text.size() && std::fflush(stream) == 0;
}

}  // namespace

void open_missing_streams() {
  constexpr const char* devices[] = {"/dev/null", "/dev/full", "/dev/null"};
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
    // The lowest number that is free is this one: those below are open by now.
    if (fcntl(stream, F_GETFD) != -1 || errno != EBADF) continue;
    if (open(devices[stream], stream == STDIN_FILENO ? O_RDONLY : O_WRONLY) == STDOUT_FILENO)
      was_closed = true;
  }
}

void print_out(std::string_view text) {
  errno = 0;
  if (!write_all(stdout, text) && output_error == 0) output_error = was_closed ? EBADF : errno;
}

void print_error(std::string_view text) {
  write_all(stderr, text);
}

std::string output_failure() {
  return output_error == 0 ? "" : std::strerror(output_error);
}

}  // namespace rhexis::runtime
