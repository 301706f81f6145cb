// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/folder_plan.hpp"

#include <fmt/format.h>

#include <cstdlib>

namespace rhexis::scenes {
namespace {

using Names = std::vector<std::string>;

void append(Names& names, const Names& more, const std::string& folder = "") {
  for (const std::string& name : more) names.push_back(folder + name);
}

/// Those of network_files.hpp.
Names network_names(const Configuration& c) {
  Names names = output::series_files("network", output::formats_of(c.output));
  const bool implicit = c.network.resolved_tier() == network::Tier::implicit_tree;
  if (implicit && c.network.statistics) append(names, {"generations.csv", "histograms.csv"});
  if (!implicit) names.emplace_back("vessels.csv");
  if (c.screening.top > 0) append(names, {"screening.csv", "risk_histograms.csv"});
  if (c.network.vtp) names.emplace_back("network.vtp");
  return names;
}

/// What a vessel's run writes, whatever its first step is.
Names vessel_names(const Configuration& c) {
  Names names{"history.csv", "run.json"};
  if (!c.is_coupled()) return names;
  append(names, network_names(c));
  if (c.coupling.two_way()) names.emplace_back("coupling.csv");
  return names;
}

/// Every event has a folder of its own.
Names cascade_names(const Configuration& c) {
  Names names{"cascade.csv", "run.json"}, of_event = vessel_names(c);
  append(names, network_names(c));
  append(of_event, files_of_steps(c, 0, false).names);
  for (std::int64_t event = 1; event <= c.coupling.events; ++event)
    append(names, of_event, event_name(static_cast<std::size_t>(event)) + "/");
  return names;
}

output::FutureFiles files_of(const Configuration& c, bool restarts) {
  if (c.model == Model::network) {
    Names names{"run.json"};
    append(names, network_names(c));
    return {names};
  }
  if (c.is_ensemble()) return {{"run.json", "samples.csv", "probability.csv"}};
  if (c.coupling.events > 0) return {cascade_names(c)};
  output::FutureFiles files = restarts ? output::FutureFiles{} : files_of_steps(c, 0, false);
  append(files.names, vessel_names(c));
  return files;
}

}  // namespace

output::FolderPlan folder_plan(const Configuration& c, const runtime::RunOptions& options) {
  output::FolderPlan plan{.directory = options.directory, .overwrite = options.overwrite};
  plan.reads = {c.file};
  plan.reads.insert(plan.reads.end(), c.network.files.begin(), c.network.files.end());
  if (!c.vessel.table_file.empty()) plan.reads.push_back(c.vessel.table_file);
  plan.reads.insert(plan.reads.end(), c.insitu.scripts.begin(), c.insitu.scripts.end());
  const bool restarts = !options.restart.empty();
  if (restarts) {
    plan.reads.push_back(options.restart);
    plan.earlier = output::EarlierResults::keep;
  }
  plan.writes = files_of(c, restarts);
  if (c.output.movie && c.insitu.enabled && !c.insitu.scripts.empty() && !c.is_ensemble() &&
      c.model != Model::network)
    plan.writes.names.emplace_back("movie.mp4");
  return plan;
}

std::string series_name(long first_step, bool restarts) {
  return restarts ? fmt::format("particles_from_{:06d}", first_step) : "particles";
}

std::string checkpoint_name(long step) {
  return fmt::format("checkpoints/step_{:06d}.h5", step);
}

std::string event_name(std::size_t event) {
  return fmt::format("event_{:02d}", event);
}

std::string event_checkpoint_name(std::size_t event) {
  return fmt::format("checkpoints/{}.h5", event_name(event));
}

std::size_t event_number(const std::string& name) {
  constexpr std::string_view before = "event_";
  if (!name.starts_with(before)) return 0;
  return static_cast<std::size_t>(std::atol(name.c_str() + before.size()));
}

output::FutureFiles files_of_steps(const Configuration& c, long first_step, bool restarts) {
  output::FutureFiles files;
  if (!c.output.fields.empty()) {
    files.names = output::series_files(series_name(first_step, restarts), output::formats_of(c.output));
  }
  files.may_be_written = [first_step, last_step = c.wall ? c.wall->time.count : 0](const std::string& name) {
    constexpr std::string_view before = "checkpoints/step_";
    if (!name.starts_with(before)) return false;
    const long step = std::atol(name.c_str() + before.size());
    return step > first_step && step <= last_step && name == checkpoint_name(step);
  };
  return files;
}

}  // namespace rhexis::scenes
