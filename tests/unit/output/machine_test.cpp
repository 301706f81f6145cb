// SPDX-License-Identifier: BSD-3-Clause
// What the machine tells of itself.
#include "output/machine.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <thread>
#include <vector>

#include "temporary_directory.hpp"

namespace rhexis::output {
namespace {

void write(const std::filesystem::path& file, double value) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << static_cast<std::int64_t>(value) << '\n';
}

TEST(EnergyMeter, AddsPackagesAndKnowsThatCountersStartAnew) {
  const test::TemporaryDirectory folder;
  if (!parallel::Communicator::world().is_root()) return;  // one folder for all
  for (const char* zone : {"intel-rapl:0", "intel-rapl:1", "intel-rapl:0:0", "intel-rapl"}) {
    write(folder / zone / "energy_uj", 900e6);
    write(folder / zone / "max_energy_range_uj", 1000e6);
  }
  EnergyMeter meter(folder.path());
  EXPECT_EQ(meter.read(), 0);
  write(folder / "intel-rapl:0/energy_uj", 950e6);
  write(folder / "intel-rapl:0:0/energy_uj", 940e6);  // within the package
  EXPECT_EQ(meter.read(), 50);
  write(folder / "intel-rapl:0/energy_uj", 20e6);
  write(folder / "intel-rapl:1/energy_uj", 905e6);
  EXPECT_EQ(meter.read(), 50 + 70 + 5);
}

TEST(EnergyMeter, LooksByItself) {
  const test::TemporaryDirectory folder;
  if (!parallel::Communicator::world().is_root()) return;  // one folder for all
  const std::filesystem::path zone = folder / "intel-rapl:0", counter = zone / "energy_uj";
  write(zone / "max_energy_range_uj", 1000e6);
  write(counter, 0);
  EnergyMeter meter(folder.path(), std::chrono::milliseconds(1));
  // Higher each time than it will be when asked: without a look in between, turns of the counter are lost.
  for (int turn = 0; turn < 3; ++turn) {
    for (const double value : {400e6, 800e6, 100e6}) {
      write(folder / "next", value);
      std::filesystem::rename(folder / "next", counter);
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
    }
  }
  EXPECT_EQ(meter.read(), 3 * 1000 + 100);
}

TEST(EnergyMeter, SaysNothingWithoutCounters) {
  EXPECT_EQ(EnergyMeter("/nowhere").read(), std::nullopt);
}

TEST(PeakResidentBytes, GrowsWithWhatIsTouched) {
  const std::int64_t before = peak_resident_bytes();
  std::vector<char> memory(64 << 20);
  // Volatile, or a compiler may see that nobody reads it and leave it all out.
  for (std::size_t i = 0; i < memory.size(); i += 1024) *static_cast<volatile char*>(&memory[i]) = 1;
  EXPECT_GT(before, 1 << 20);
  // Memory held earlier and given back may serve a part of it.
  EXPECT_GT(peak_resident_bytes() - before, 32 << 20);
}

TEST(ProcessorName, IsALineAtMost) {
  EXPECT_EQ(processor_name().find('\n'), std::string::npos);
}

}  // namespace
}  // namespace rhexis::output
