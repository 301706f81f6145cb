// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/coupled/coupled_files.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <string_view>
#include <vector>

#include "coupling/coupled_vessel.hpp"
#include "scenes/vessel/vessel_files.hpp"

namespace rhexis::scenes {
namespace {

using Names = std::vector<std::string>;

constexpr std::string_view event_prefix = "event_";

Names network_names(const CoupledScene& s) {
  return studies::network_file_names(network_files_plan(s, s.network, s.output), s.network.problem,
                                     s.network.screening.top > 0);
}

/// What the run of a coupled vessel writes, whatever its first step is.
Names coupled_names(const CoupledScene& s) {
  Names names = vessel_file_names();
  append(names, network_names(s));
  if (s.coupling.two_way()) names.emplace_back(coupling::exchange_table_name);
  return names;
}

/// Every event has a folder of its own.
Names cascade_names(const CoupledScene& s) {
  Names names{cascade_table_name, "run.json"}, of_event = coupled_names(s);
  append(names, network_names(s));
  append(of_event, files_of_steps(s.output, 0, 0, false).names);
  for (std::int64_t event = 1; event <= s.coupling.events; ++event)
    for (const std::string& name : of_event)
      names.push_back(event_name(static_cast<std::size_t>(event)) + "/" + name);
  return names;
}

}  // namespace

output::FolderPlan folder_plan(const CoupledScene& s, const runtime::RunOptions& options) {
  Names reads = s.network.problem.network.files;
  append(reads, s.pictures.insitu.scripts);
  output::FolderPlan plan = plan_of_folder(s, options, reads);
  if (s.is_cascade()) {
    plan.writes.names = cascade_names(s);
  } else {
    if (options.restart.empty()) plan.writes = files_of_steps(s.output, 0, 0, false);
    append(plan.writes.names, coupled_names(s));
  }
  append(plan.writes.names, movie_names(s.output, s.pictures));
  return plan;
}

std::string event_name(std::size_t event) {
  return fmt::format("{}{:02d}", event_prefix, event);
}

std::string event_checkpoint_name(std::size_t event) {
  return fmt::format("checkpoints/{}.h5", event_name(event));
}

std::size_t event_number(const std::string& name) {
  if (!name.starts_with(event_prefix)) return 0;
  return static_cast<std::size_t>(std::atol(name.c_str() + event_prefix.size()));
}

}  // namespace rhexis::scenes
