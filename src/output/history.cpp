// SPDX-License-Identifier: BSD-3-Clause
#include "output/history.hpp"

#include <fmt/format.h>

#include <utility>

#include "core/error.hpp"
#include "output/kept_rows.hpp"
#include "parallel/together.hpp"

namespace rhexis::output {
namespace {

constexpr const char* header =
    "step,time_s,pressure_Pa,max_displacement_m,max_damage,broken_bonds,kinetic_J,strain_J,external_work_J,"
    "rupture_length_m,leak_m3_s,fracture_J,opening_m2";

std::string line_of(const HistoryRow& row) {
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", row.step, row.time_s, row.pressure_Pa,
                     row.max_displacement_m, row.max_damage, row.broken_bonds, row.kinetic_J, row.strain_J,
                     row.external_work_J, row.rupture_length_m,
                     row.leak_m3_s ? fmt::format("{}", *row.leak_m3_s) : std::string{}, row.fracture_J,
                     row.opening_m2);
}

}  // namespace

std::string kept_history(const std::filesystem::path& path, long last_step) {
  return kept_rows(path, header, [&](double step) { return step <= static_cast<double>(last_step); });
}

History::History(std::filesystem::path path, parallel::Communicator communicator)
    : path_(std::move(path)), communicator_(communicator) {
  start_with(fmt::format("{}\n", header));
}

History::History(std::filesystem::path path, parallel::Communicator communicator, long restart_step)
    : path_(std::move(path)), communicator_(communicator) {
  std::string kept;
  parallel::on_root<InputError>(communicator_, [&] { kept = kept_history(path_, restart_step); });
  start_with(kept);
}

void History::start_with(const std::string& text) {
  parallel::on_root<RunError>(communicator_, [&] { file_ = TableFile(path_, text); });
}

void History::append(const HistoryRow& row) {
  parallel::on_root<RunError>(communicator_, [&] { file_.append(line_of(row)); });
}

}  // namespace rhexis::output
