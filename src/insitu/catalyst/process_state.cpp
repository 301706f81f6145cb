// SPDX-License-Identifier: BSD-3-Clause
#include "insitu/catalyst/process_state.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>

#include <clocale>
#include <cstdlib>
#include <cstring>

namespace rhexis::insitu {
namespace {

std::map<std::string, std::string> environment() {
  std::map<std::string, std::string> all;
  for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
    const std::string text = *entry;
    const std::size_t equals = text.find('=');
    if (equals != std::string::npos) all.emplace(text.substr(0, equals), text.substr(equals + 1));
  }
  return all;
}

/// Whether this program, its libraries or a program that it starts would obey a new variable of this name.
bool is_obeyed(const std::string& name) {
  for (const char* prefix : {"OMP_", "GOMP_", "OMPI_", "RHEXIS_", "LC_", "LD_"})
    if (name.starts_with(prefix)) return true;
  return name == "LANG";
}

mode_t current_mask() {
  const mode_t mask = umask(0);
  umask(mask);
  return mask;
}

bool same(const struct sigaction& a, const struct sigaction& b) {
  return a.sa_handler == b.sa_handler && a.sa_flags == b.sa_flags;
}

}  // namespace

ProcessState::ProcessState()
    : process_(getpid()),
      numbers_(std::setlocale(LC_NUMERIC, nullptr)),
      mask_(current_mask()),
      environment_(environment()) {
  std::error_code ignored;
  folder_ = std::filesystem::current_path(ignored);
  for (int signal = 1; signal < NSIG; ++signal)
    sigaction(signal, nullptr, &handlers_[static_cast<std::size_t>(signal)]);
  for (std::size_t i = 0; i < streams_.size(); ++i) streams_[i] = remember(static_cast<int>(i));
  std::fegetenv(&floating_point_);
}

ProcessState::~ProcessState() {
  for (const Stream& stream : streams_)
    if (stream.copy >= 0) close(stream.copy);
}

ProcessState::Stream ProcessState::remember(int descriptor) {
  struct stat status {};
  if (fstat(descriptor, &status) != 0) return {};
  return {fcntl(descriptor, F_DUPFD_CLOEXEC, 3), status.st_dev, status.st_ino};
}

std::string ProcessState::restore() const {
  if (getpid() != process_) _exit(1);
  std::string changes;
  const auto note = [&](const std::string& change) { changes += (changes.empty() ? "" : "; ") + change; };
  std::fesetenv(&floating_point_);  // libraries that a script loads may set it without being asked to
  std::error_code ignored;
  if (const auto folder = std::filesystem::current_path(ignored); folder != folder_) {
    std::filesystem::current_path(folder_, ignored);
    note("changed the working folder from " + folder_.string() + " to " + folder.string());
  }
  for (int signal = 1; signal < NSIG; ++signal) {
    const struct sigaction& before = handlers_[static_cast<std::size_t>(signal)];
    struct sigaction now {};
    if (sigaction(signal, nullptr, &now) != 0 || same(now, before)) continue;
    sigaction(signal, &before, nullptr);
    if (now.sa_handler == SIG_DFL) continue;  // perhaps by the solver's own handler, as the signal came
    note(std::string("replaced the handler of SIG") + sigabbrev_np(signal));
  }
  itimerval timer{};
  if (getitimer(ITIMER_REAL, &timer) == 0 && (timer.it_value.tv_sec != 0 || timer.it_value.tv_usec != 0)) {
    alarm(0);
    note("set a timer that sends SIGALRM");
  }
  if (numbers_ != std::setlocale(LC_NUMERIC, nullptr)) {
    note(std::string("changed the locale of numbers to ") + std::setlocale(LC_NUMERIC, nullptr));
    std::setlocale(LC_NUMERIC, numbers_.c_str());
  }
  if (umask(mask_) != mask_) note("changed the file mode mask");
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    struct stat status {};
    const Stream& before = streams_[i];
    const bool open = fstat(static_cast<int>(i), &status) == 0;
    if (before.copy < 0 || (open && status.st_dev == before.device && status.st_ino == before.file)) continue;
    dup2(before.copy, static_cast<int>(i));
    constexpr std::array names = {"input", "output", "error"};
    note(std::string("closed or redirected standard ") + names[i]);
  }
  for (const auto& [name, value] : environment()) {
    const auto before = environment_.find(name);
    if (before == environment_.end() ? !is_obeyed(name) : before->second == value) continue;
    note("changed the environment variable " + name);
    if (before == environment_.end()) unsetenv(name.c_str());
  }
  for (const auto& [name, value] : environment_) {
    if (std::getenv(name.c_str()) == nullptr) note("removed the environment variable " + name);
    setenv(name.c_str(), value.c_str(), /*overwrite=*/1);
  }
  return changes;
}

}  // namespace rhexis::insitu
