// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/vessel/vessel_files.hpp"

#include <fmt/format.h>

#include <cstdlib>

namespace rhexis::scenes {

output::FolderPlan folder_plan(const VesselScene& s, const runtime::RunOptions& options) {
  std::vector<std::string> reads = s.pictures.insitu.scripts;
  if (!s.vessel.table_file.empty()) reads.push_back(s.vessel.table_file);
  output::FolderPlan plan = plan_of_folder(s, options, reads);
  if (options.restart.empty()) plan.writes = files_of_steps(s.output, 0, s.wall->time.count, false);
  append(plan.writes.names, vessel_file_names());
  append(plan.writes.names, movie_names(s.output, s.pictures));
  return plan;
}

std::vector<std::string> vessel_file_names() {
  return {"history.csv", "run.json"};
}

std::vector<std::string> movie_names(const output::Parameters& output,
                                     const runtime::PicturesPlan& pictures) {
  if (!output.movie || !pictures.insitu.enabled || pictures.insitu.scripts.empty()) return {};
  return {"movie.mp4"};
}

std::string series_name(long first_step, bool restarts) {
  return restarts ? fmt::format("particles_from_{:06d}", first_step) : "particles";
}

std::string checkpoint_name(long step) {
  return fmt::format("checkpoints/step_{:06d}.h5", step);
}

output::FutureFiles files_of_steps(const output::Parameters& output, long first_step, long last_step,
                                   bool restarts) {
  output::FutureFiles files;
  if (!output.fields.empty())
    files.names = output::series_files(series_name(first_step, restarts), output::formats_of(output));
  files.may_be_written = [first_step, last_step](const std::string& name) {
    constexpr std::string_view before = "checkpoints/step_";
    if (!name.starts_with(before)) return false;
    const long step = std::atol(name.c_str() + before.size());
    return step > first_step && step <= last_step && name == checkpoint_name(step);
  };
  return files;
}

}  // namespace rhexis::scenes
