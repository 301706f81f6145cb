#include "output/history.hpp"

#include <fmt/format.h>

#include <sstream>
#include <utility>

#include "core/error.hpp"
#include "core/text_file.hpp"
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

/// The header and the complete rows up to `last_step` of the file; the header alone where there is no file.
std::string kept_text(const std::filesystem::path& path, long last_step) {
  std::string kept = fmt::format("{}\n", header);
  if (!std::filesystem::exists(path)) return kept;
  std::istringstream file(whole_file(path));
  std::string line;
  std::getline(file, line);
  if (line != header) {
    throw InputError(fmt::format("{}: not a history of this program: its first line should be '{}'",
                                 path.string(), header));
  }
  // getline meets the end of the file on a last line without a line break: one that a crash cut short.
  while (std::getline(file, line) && !file.eof()) {
    long step = 0;
    if (!(std::istringstream(line) >> step)) {
      throw InputError(fmt::format("{}: this row does not begin with a step: '{}'", path.string(), line));
    }
    if (step <= last_step) kept += line + '\n';
  }
  return kept;
}

}  // namespace

History::History(std::filesystem::path path, parallel::Communicator communicator)
    : path_(std::move(path)), communicator_(communicator) {
  start_with(fmt::format("{}\n", header));
}

History::History(std::filesystem::path path, parallel::Communicator communicator, long restart_step)
    : path_(std::move(path)), communicator_(communicator) {
  std::string kept;
  parallel::on_root<InputError>(communicator_, [&] { kept = kept_text(path_, restart_step); });
  start_with(kept);
}

void History::start_with(const std::string& text) {
  parallel::on_root<RunError>(communicator_, [&] { file_ = TableFile(path_, text); });
}

void History::append(const HistoryRow& row) {
  parallel::on_root<RunError>(communicator_, [&] { file_.append(line_of(row)); });
}

}  // namespace rhexis::output
