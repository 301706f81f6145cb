// SPDX-License-Identifier: BSD-3-Clause
// Checkpoints of a vessel's run: what they hold, and going on from one.
#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
#include "core/format.hpp"
#include "core/stopwatch.hpp"
#include "coupling/network_load.hpp"
#include "output/checkpoint.hpp"
#include "parallel/together.hpp"
#include "runtime/version.hpp"
#include "scenes/checkpoint_input.hpp"
#include "scenes/vessel/vessel_files.hpp"
#include "scenes/vessel/vessel_run.hpp"

namespace rhexis::scenes {
namespace {

constexpr const char* axes[] = {"x", "y", "z"};
constexpr double largest = output::CheckpointReader::largest;

output::WordBlock word_block(const peridynamics::Body& body) {
  const peridynamics::BondWordLayout l = body.bond_word_layout();
  return {l.rows, l.words, l.first_row, l.row_count, l.first_word, l.word_count};
}

/// The distributed arrays, by name and layout, once for writing and for reading.
template <class Saved, class Visit>
void for_each_array(const peridynamics::Body& body, Saved& saved, const Visit& visit) {
  for (std::size_t k = 0; k < 3; ++k) {
    visit(fmt::format("displacement_{}", axes[k]), body.layout(), saved.displacement[k]);
    visit(fmt::format("leapfrog_velocity_{}", axes[k]), body.layout(), saved.leapfrog_velocity[k]);
  }
  visit("intact_bonds", word_block(body), saved.words);
}

}  // namespace

/// Names, members and the range that makes sense of all numbers but those that are compared, once for writing
/// and for reading. SI units.
template <class Visit>
void VesselRun::for_each_number(peridynamics::Body::Saved& saved, peridynamics::RuptureEvents& rupture,
                                peridynamics::LoadState& load, const Visit& visit) {
  visit("frame_phase", saved.frame_phase, 0, largest);
  visit("wrapped", saved.wrapped);
  visit("first_kick_pending", saved.first_kick_pending);
  for (std::size_t i = 0; i < 2; ++i) {
    visit(fmt::format("external_work_{}", i), saved.external_work[i]);
    visit(fmt::format("released_energy_{}", i), saved.released_energy[i]);
  }
  visit("load_speed", saved.load_speed, 0, largest);
  for (std::size_t k = 0; k < 3; ++k) visit(fmt::format("frame_{}", axes[k]), saved.frame[k]);
  // Venting only lowers the load; a network may also raise it, where the lumen widens.
  visit("pressure_share", load.share, 0,
        coupling_ != nullptr && coupling_->coupled().two_way() ? largest : 1);
  visit("least_pressure_share", load.least_share, 0, 1);
  visit("opening_area", load.open_area, 0, largest);
  visit("resistance_factor", load.resistance_factor, 0, largest);
  visit("told_of_crushed_bonds", crushing_was_told_);
  visit("told_of_turbulence", turbulence_was_told_);
  visit("first_bond_break_time", rupture.first_break, 0, largest);
  visit("rupture_onset_time", rupture.onset, 0, largest);
  visit("pressure_at_onset", rupture.pressure, 0, largest);
  visit("blood_pressure_at_onset", rupture.blood_pressure, 0, largest);
  visit("max_displacement_at_onset", rupture.max_displacement, 0, largest);
}

void VesselRun::write_checkpoint(long step) {
  const Stopwatch watch(session_.spent().output);
  const peridynamics::Body& body = simulation_->body();
  peridynamics::Body::Saved saved = body.save();
  peridynamics::RuptureEvents rupture = simulation_->rupture();
  peridynamics::LoadState load = simulation_->load();
  const std::filesystem::path path = session_.folder().claim(checkpoint_name(step));
  output::CheckpointWriter file(path, runtime::version(), comm_);
  write_input(file, c_, &c_.wall->parameters);
  file.write(step_name, std::int64_t{step});
  file.write("time_step", c_.wall->time.step);
  file.write("scheduled_pressure", simulation_->scheduled_pressure_at(step));
  for_each_number(saved, rupture, load,
                  [&](const std::string& name, const auto& value, auto...) { file.write(name, value); });
  for_each_array(body, saved, [&](const std::string& name, const auto& layout, const auto& values) {
    file.write(name, layout, values);
  });
  if (coupling_ != nullptr) coupling_->save(file);
  file.close();
  last_checkpoint_ = path;
  if (signal_ == 0) return;
  if (comm_.is_root()) session_.record().fail_alone(runtime::interrupted_by(signal_));
  session_.console().important(
      fmt::format("  {}; go on with --restart {}", runtime::interrupted_by(signal_), path.string()));
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
  if (coupling_ == nullptr && file.holds(coupling::coupled_vessel_name))
    file.refuse("the checkpoint is of a vessel that is coupled with a network");
  std::int64_t step = 0;
  file.read(step_name, step, 0);
  first_step_ = step;
  // From the last step a run goes on that was killed before it had stored and drawn that step.
  if (first_step_ > c_.wall->time.count) {
    file.refuse(fmt::format("the checkpoint is of step {}, this run ends at step {}; raise time.end",
                            first_step_, c_.wall->time.count));
  }
  if (coupling_ != nullptr)
    coupling_->restore(file, simulation_->time_at(first_step_), session_.options().directory);
  compare_with(file);
  peridynamics::Body& body = simulation_->body();
  peridynamics::Body::Saved saved = body.save();
  peridynamics::RuptureEvents rupture;
  peridynamics::LoadState load;
  for_each_number(saved, rupture, load, [&](const std::string& name, auto& value, auto... range) {
    file.read(name, value, range...);
  });
  for_each_array(body, saved, [&](const std::string& name, const auto& layout, auto& values) {
    file.read(name, layout, values);
  });
  body.restore(saved);
  if (!std::isfinite(body.save().external_work[0]))
    file.refuse("'external_work_0' makes no sense: it is beyond all energies of this body");
  if (coupling_ != nullptr) coupling::NetworkLoad(coupling_->coupled()).start(*simulation_);
  load.next_share = load.share;
  simulation_->resume(first_step_, rupture, load);
  results_.first_bond_break_s = rupture.first_break;
  results_.rupture_onset_s = rupture.onset;
  results_.pressure_at_onset_Pa = rupture.pressure;
  results_.blood_pressure_at_onset_Pa = rupture.blood_pressure;
  results_.max_displacement_at_onset_m = rupture.max_displacement;
  // What is continued is read before anything is written.
  parallel::on_root<InputError>(
      comm_, [&] { output::kept_history(session_.options().directory / "history.csv", first_step_ - 1); });
}

}  // namespace rhexis::scenes
