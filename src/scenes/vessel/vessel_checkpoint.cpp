// SPDX-License-Identifier: BSD-3-Clause
// Checkpoints of a vessel's run: what they hold, and going on from one.
#include <fmt/format.h>

#include "core/error.hpp"
#include "core/format.hpp"
#include "coupling/coupled_vessel.hpp"
#include "output/checkpoint.hpp"
#include "parallel/together.hpp"
#include "runtime/version.hpp"
#include "scenes/checkpoint_input.hpp"
#include "scenes/vessel/vessel_files.hpp"
#include "scenes/vessel/vessel_run.hpp"

namespace rhexis::scenes {

output::CheckpointObserver::Plan VesselRun::checkpoint_plan() {
  return {
      .every = c_.output.checkpoint_every,
      .write = [this](long step) { return write_checkpoint(step); },
      .interrupted =
          [this](int signal, const std::filesystem::path& path) {
            const std::string reason = runtime::interrupted_by(signal);
            if (comm_.is_root()) session_.record().fail_alone(reason);
            session_.console().important(fmt::format("  {}; go on with --restart {}", reason, path.string()));
          },
      .failed =
          [this](const std::filesystem::path& path) {
            session_.console().important(fmt::format("  failed; go on with --restart {}", path.string()));
          },
      .warn = [this](const std::string& reason) { session_.warn(reason); }};
}

std::filesystem::path VesselRun::write_checkpoint(long step) {
  const std::filesystem::path path = session_.folder().claim(checkpoint_name(step));
  output::CheckpointWriter file(path, runtime::version(), comm_);
  write_input(file, c_, &c_.wall->parameters);
  file.write(step_name, std::int64_t{step});
  file.write("time_step", c_.wall->time.step);
  file.write("scheduled_pressure", simulation_->scheduled_pressure_at(step));
  studies::save_wall(*simulation_, given_warnings_, file);
  if (network_ != nullptr) network_->save(file);
  file.close();
  return path;
}

/// Refuses the checkpoint of another body or time step; warns of another load.
void VesselRun::compare_with(output::CheckpointReader& file) {
  compare_input(file, c_, &c_.wall->parameters, fmt::format("step {}", first_step_));
  double time_step = 0, pressure = 0;
  file.read("time_step", time_step);
  if (time_step != c_.wall->time.step) {
    file.refuse(
        fmt::format("the checkpoint was made with a time step of {} s, this run has {} s; set time.step",
                    time_step, c_.wall->time.step));
  }
  file.read("scheduled_pressure", pressure);
  if (pressure != simulation_->scheduled_pressure_at(first_step_)) {
    c_.warnings.push_back(fmt::format("the schedule had {} at step {}, and now has {}",
                                      quantity(pressure, "Pa"), first_step_,
                                      quantity(simulation_->scheduled_pressure_at(first_step_), "Pa")));
  }
}

void VesselRun::read_checkpoint() {
  output::CheckpointReader file(session_.options().restart, comm_);
  if (!file.holds(step_name))
    file.refuse("the checkpoint is of a cascade between two events; only that cascade goes on from it");
  if (network_ == nullptr && file.holds(coupling::coupled_vessel_name))
    file.refuse("the checkpoint is of a vessel that is coupled with a network");
  std::int64_t step = 0;
  file.read(step_name, step, 0);
  first_step_ = step;
  // From the last step a run goes on that was killed before it had stored and drawn that step.
  if (first_step_ > c_.wall->time.count) {
    file.refuse(fmt::format("the checkpoint is of step {}, this run ends at step {}; raise time.end",
                            first_step_, c_.wall->time.count));
  }
  if (network_ != nullptr)
    network_->restore(file, simulation_->time_at(first_step_), session_.options().directory);
  compare_with(file);
  if (network_ != nullptr) network_->start(*simulation_);
  studies::restore_wall(*simulation_, *load_, given_warnings_, first_step_, file);
  // What is continued is read before anything is written.
  parallel::on_root<InputError>(
      comm_, [&] { output::kept_history(session_.options().directory / "history.csv", first_step_ - 1); });
}

}  // namespace rhexis::scenes
