/// What the machine tells of itself: processor, memory, energy.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace rhexis::output {

/// Peak resident memory of this process, bytes.
std::int64_t peak_resident_bytes();

/// The processor's name as Linux gives it; empty where it gives none.
std::string processor_name();

/// Energy that this node's processors use, by the counters that Linux shows of them (RAPL). Virtual machines
/// have none, and often only root may read them.
class EnergyMeter {
 public:
  explicit EnergyMeter(const std::filesystem::path& counters = "/sys/class/powercap");

  /// J since construction; none without counters. Counters start anew after some minutes of full load (by
  /// their range): ask at least that often.
  std::optional<double> read();

 private:
  struct Counter {
    std::filesystem::path file;
    double range, last;  ///< uJ
  };
  std::vector<Counter> counters_;
  double used_ = 0;  ///< uJ
};

}  // namespace rhexis::output
