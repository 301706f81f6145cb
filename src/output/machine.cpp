// SPDX-License-Identifier: BSD-3-Clause
#include "output/machine.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

#include "core/memory.hpp"

namespace rhexis::output {
std::int64_t peak_resident_bytes() {
  // VmHWM, because ru_maxrss also counts the process that started this one.
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::int64_t kibibytes = 0;
    if (word == "VmHWM:" && status >> kibibytes) return kibibytes * 1024;
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;
}

std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return {};
}

EnergyMeter::EnergyMeter(const std::filesystem::path& counters, std::chrono::milliseconds interval) {
  std::error_code none;
  for (const auto& zone : std::filesystem::directory_iterator(counters, none)) {
    // Packages, "intel-rapl:0"; what they consist of, "intel-rapl:0:1", is in them.
    const std::string name = zone.path().filename();
    if (!name.starts_with("intel-rapl:") || name.find(':') != name.rfind(':')) continue;
    const auto now = number_in(zone.path() / "energy_uj");
    const auto range = number_in(zone.path() / "max_energy_range_uj");
    if (now && range) counters_.push_back({zone.path() / "energy_uj", *range, *now});
  }
  if (counters_.empty()) return;
  watcher_ = std::jthread([this, interval](const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
      never_.wait_for(lock, stop, interval, [] { return false; });
      look();
    }
  });
}

void EnergyMeter::look() {
  for (Counter& counter : counters_) {
    const double now = number_in(counter.file).value_or(counter.last);
    used_ += now - counter.last + (now < counter.last ? counter.range : 0);
    counter.last = now;
  }
}

std::optional<double> EnergyMeter::read() {
  if (counters_.empty()) return {};
  const std::lock_guard lock(mutex_);
  look();
  return 1e-6 * used_;
}

}  // namespace rhexis::output
