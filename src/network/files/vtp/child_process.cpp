// SPDX-License-Identifier: BSD-3-Clause
#include "network/files/vtp/child_process.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <type_traits>
#include <utility>

namespace rhexis::network::vtp {
namespace {

/// One end of a pipe. What fails once fails from then on.
class PipeEnd {
 public:
  explicit PipeEnd(int file) : file_(file) {}
  ~PipeEnd() { close(file_); }
  PipeEnd(const PipeEnd&) = delete;
  PipeEnd& operator=(const PipeEnd&) = delete;

  bool good() const { return good_; }

  void write_bytes(const void* data, std::size_t size) {
    for (const char* next = static_cast<const char*>(data); good_ && size > 0;) {
      const ssize_t done = ::write(file_, next, size);
      if (done < 0 && errno == EINTR) continue;
      good_ = done > 0;
      if (good_) next += done, size -= static_cast<std::size_t>(done);
    }
  }

  void read_bytes(void* data, std::size_t size) {
    for (char* next = static_cast<char*>(data); good_ && size > 0;) {
      const ssize_t done = ::read(file_, next, size);
      if (done < 0 && errno == EINTR) continue;
      good_ = done > 0;
      if (good_) next += done, size -= static_cast<std::size_t>(done);
    }
  }

 private:
  int file_;
  bool good_ = true;
};

/// Writes to a pipe what `operator()` is given; Receiver reads the same.
struct Sender {
  PipeEnd& pipe;
  template <class T>
  requires std::is_arithmetic_v<T>
  void operator()(const T& value) { pipe.write_bytes(&value, sizeof value); }
  template <class Container>
  requires requires(const Container& c) { c.data(); }
  void operator()(const Container& values) {
    (*this)(values.size());
    pipe.write_bytes(values.data(), values.size() * sizeof(typename Container::value_type));
  }
};

struct Receiver {
  PipeEnd& pipe;
  template <class T>
  requires std::is_arithmetic_v<T>
  void operator()(T& value) { pipe.read_bytes(&value, sizeof value); }
  template <class Container>
  requires requires(Container& c) { c.data(); }
  void operator()(Container& values) {
    std::size_t size = 0;
    (*this)(size);
    if (pipe.good()) values.resize(size);
    pipe.read_bytes(values.data(), values.size() * sizeof(typename Container::value_type));
  }
};

template <class Transfer, class Arrays>
void transfer_arrays(Transfer&& transfer, Arrays& arrays) {
  std::size_t count = arrays.size();
  transfer(count);
  if constexpr (!std::is_const_v<Arrays>) arrays.resize(count);
  for (auto& array : arrays) {
    transfer(array.name);
    transfer(array.components);
    transfer(array.values);
  }
}

template <class Transfer, class L>
void transfer_lines(Transfer&& transfer, L& lines) {
  transfer(lines.coordinates);
  transfer(lines.offsets);
  transfer(lines.connectivity);
  transfer(lines.first_cell);
  transfer_arrays(transfer, lines.point_arrays);
  transfer_arrays(transfer, lines.cell_arrays);
}

/// The memory of this process, in bytes.
std::uintmax_t address_space() {
  std::uintmax_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uintmax_t>(sysconf(_SC_PAGESIZE));
}

void limit(int resource, std::uintmax_t most) {
  rlimit limits{};
  getrlimit(static_cast<__rlimit_resource>(resource), &limits);
  limits.rlim_cur = std::min<rlim_t>(limits.rlim_max, most);
  setrlimit(static_cast<__rlimit_resource>(resource), &limits);
}

/// Signals end the child without a word, and files far smaller than what they ask for do not get it.
void restrain_this_process(std::uintmax_t bytes) {
  struct sigaction by_default = {};
  by_default.sa_handler = SIG_DFL;
  for (const int number :
       {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGTERM, SIGINT, SIGHUP, SIGPIPE})
    sigaction(number, &by_default, nullptr);
  if (const int nothing = open("/dev/null", O_WRONLY | O_CLOEXEC); nothing >= 0) {
    dup2(nothing, STDOUT_FILENO);
    dup2(nothing, STDERR_FILENO);
  }
  constexpr std::uintmax_t least_seconds = 5, bytes_per_second = 1 << 20;  // VTK reads ten times as fast
  constexpr std::uintmax_t least_memory = std::uintmax_t{2} << 30, most_compressed = 200;
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, least_seconds + bytes / bytes_per_second);
  limit(RLIMIT_AS, address_space() + least_memory + most_compressed * bytes);
}

[[noreturn]] void be_the_child(const std::function<void(Lines&, std::string&)>& read, std::uintmax_t bytes,
                               int file) {
  restrain_this_process(bytes);
  Lines lines;
  std::string problem;
  read(lines, problem);
  PipeEnd pipe(file);
  Sender send{pipe};
  send(problem);
  if (problem.empty()) transfer_lines(send, std::as_const(lines));
  _exit(pipe.good() ? 0 : 1);
}

std::string ending_of(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return std::string("VTK's process was lost: ") + std::strerror(errno);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  const std::string reason = !WIFSIGNALED(status) ? "gave up on it"
                             : WTERMSIG(status) == SIGXCPU
                                 ? "finds no end of it"
                                 : std::string("crashed on it (") + strsignal(WTERMSIG(status)) + ")";
  return "VTK " + reason + ": the numbers in the file's tags do not fit its data";
}

}  // namespace

void read_in_child(const std::function<void(Lines&, std::string&)>& read, std::uintmax_t bytes, Lines& lines,
                   std::string& problem) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    problem = std::string("no pipe: ") + std::strerror(errno);
    return;
  }
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    be_the_child(read, bytes, ends[1]);
  }
  const int fork_error = errno;
  close(ends[1]);
  PipeEnd pipe(ends[0]);
  if (child < 0) {
    problem = std::string("no process for VTK: ") + std::strerror(fork_error);
    return;
  }
  Receiver receive{pipe};
  receive(problem);
  if (problem.empty()) transfer_lines(receive, lines);
  if (const std::string ending = ending_of(child); !ending.empty()) problem = ending;
  if (problem.empty() && !pipe.good()) problem = "VTK's process ended early";
}

}  // namespace rhexis::network::vtp
