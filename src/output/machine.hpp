// SPDX-License-Identifier: BSD-3-Clause
/// What the machine tells of itself: processor, memory, energy.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace rhexis::output {

/// Peak resident memory of this process, bytes.
std::int64_t peak_resident_bytes();

/// The processor's name as Linux gives it; empty where it gives none.
std::string processor_name();

/// Energy that this node's processors use, by the counters that Linux shows of them (RAPL). Virtual machines
/// have none, and often only root may read them.
///
/// Counters start anew after some minutes of full load (by their range), so a thread looks at them from time
/// to time.
class EnergyMeter {
 public:
  explicit EnergyMeter(const std::filesystem::path& counters = "/sys/class/powercap",
                       std::chrono::milliseconds interval = std::chrono::minutes(1));

  /// J since construction; none without counters.
  std::optional<double> read();

 private:
  void look();

  struct Counter {
    std::filesystem::path file;
    double range, last;  ///< uJ
  };
  std::vector<Counter> counters_;
  double used_ = 0;   ///< uJ
  std::mutex mutex_;  ///< guards all above
  std::condition_variable_any never_;
  std::jthread watcher_;  ///< where there are counters
};

}  // namespace rhexis::output
