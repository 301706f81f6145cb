// SPDX-License-Identifier: BSD-3-Clause
/// history.csv: the run in numbers, one row per output.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "output/atomic_file.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::output {

/// One row; the columns of the file are named as the members, in this order, units included.
struct HistoryRow {
  long step = 0;
  double time_s = 0;
  double pressure_Pa = 0;
  double max_displacement_m = 0;
  double max_damage = 0;
  long broken_bonds = 0;
  double kinetic_J = 0;
  double strain_J = 0;
  double external_work_J = 0;
  double rupture_length_m = 0;
  std::optional<double> leak_m3_s = {};  ///< empty cell where there is no leak to speak of
  double fracture_J = 0;
  double opening_m2 = 0;
};

/// What a restart keeps of the history `path`: its rows up to and including `last_step`. Throws InputError if
/// the file is no history, or damaged (kept_rows.hpp). Local to the calling rank.
std::string kept_history(const std::filesystem::path& path, long last_step);

/// Appends rows, each handed to the system before the next step begins. Collective; only the root touches the
/// file. Numbers are the shortest decimals that read back as the same double.
class History {
 public:
  /// Starts a new file. Throws RunError on all ranks if it cannot be written.
  History(std::filesystem::path path, parallel::Communicator communicator);

  /// Continues the file of the run that left a checkpoint at `restart_step`: keeps its rows up to and
  /// including that step, drops later ones and a row that a crash cut short. Starts a new file where there is
  /// none. Throws InputError as kept_history.
  History(std::filesystem::path path, parallel::Communicator communicator, long restart_step);

  /// Adds a row. Throws RunError on all ranks if it cannot be written (disk full).
  void append(const HistoryRow& row);

 private:
  void start_with(const std::string& text);

  std::filesystem::path path_;
  parallel::Communicator communicator_;
  TableFile file_;
};

}  // namespace rhexis::output
