// Checkpoints of a vessel's run: what they hold, and going on from one.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "app/stopwatch.hpp"
#include "app/vessel_run.hpp"
#include "core/error.hpp"
#include "input/catalogue.hpp"
#include "output/checkpoint.hpp"

namespace rhexis::app {
namespace {

constexpr const char* axes[] = {"x", "y", "z"};

output::WordBlock word_block(const peridynamics::Body& body) {
  const peridynamics::BondWordLayout l = body.bond_word_layout();
  return {l.rows, l.words, l.first_row, l.row_count, l.first_word, l.word_count};
}

/// The keys that make a body what it is, with their values: what a checkpoint can only be restored to. Where
/// a network says what the vessel is like, that.
std::string body_description(const Configuration& c) {
  nlohmann::ordered_json values;
  constexpr std::array of_the_body = {"vessel", "material", "scatter", "spot", "discretisation", "boundary"};
  for (const auto& [section, keys] : c.record.items()) {
    if (std::ranges::find(of_the_body, input::without_table(section)) == of_the_body.end()) continue;
    for (const auto& [key, entry] : keys.items()) values[section][key] = entry.at("value");
  }
  if (c.is_coupled()) {
    values["vessel"] = {{"inner_radius", c.vessel.inner_radius},
                        {"outer_radius", c.vessel.outer_radius},
                        {"length", c.vessel.length},
                        {"critical_stretch", *c.vessel.critical_stretch}};
  }
  return values.dump();
}

/// A number that may be absent, as checkpoints store it: times and lengths here are never negative.
constexpr double absent = -1;

std::optional<double> present(double stored) {
  return stored >= 0 ? std::optional<double>(stored) : std::nullopt;
}

}  // namespace

void VesselRun::write_checkpoint(long step) {
  if (coupling_ != nullptr && coupling_->two_way()) return;  // asked for by an interrupt
  const Stopwatch watch(spent_.output);
  const peridynamics::Body::Saved saved = body_->save();
  const auto path = options_.directory / "checkpoints" / fmt::format("step_{:06d}.h5", step);
  output::CheckpointWriter file(path, comm_);
  file.write("step", std::int64_t{step});
  file.write("body", body_description(c_));
  file.write("time_step", c_.time_step);
  file.write("frame_phase", std::int64_t{saved.frame_phase});
  file.write("wrapped", std::int64_t{saved.wrapped});
  file.write("first_kick_pending", std::int64_t{saved.first_kick_pending});
  for (std::size_t i = 0; i < 2; ++i) {
    file.write(fmt::format("external_work_{}", i), saved.external_work[i]);
    file.write(fmt::format("released_energy_{}", i), saved.released_energy[i]);
  }
  file.write("load_speed", saved.load_speed);
  file.write("vent", vent_now_);
  file.write("first_bond_break", results_.first_bond_break_s.value_or(absent));
  file.write("rupture_onset", results_.rupture_onset_s.value_or(absent));
  file.write("onset_displacement", results_.max_displacement_at_onset_m.value_or(absent));
  for (std::size_t k = 0; k < 3; ++k) {
    file.write(fmt::format("frame_{}", axes[k]), saved.frame[k]);
    file.write(fmt::format("displacement_{}", axes[k]), body_->layout(), saved.displacement[k]);
    file.write(fmt::format("leapfrog_velocity_{}", axes[k]), body_->layout(), saved.leapfrog_velocity[k]);
  }
  file.write("intact_bonds", word_block(*body_), saved.words);
  file.close();
  if (interrupted_) {
    console_.line("  interrupted; go on with --restart " + path.string());
  }
}

void VesselRun::read_checkpoint() {
  output::CheckpointReader file(options_.restart, comm_);
  peridynamics::Body::Saved saved = body_->save();
  double time_step = 0, onset = absent, first_break = absent, onset_displacement = absent;
  std::int64_t pending = 0, step = 0, frame_phase = 0, wrapped = 0;
  file.read("step", step);
  first_step_ = static_cast<long>(step);
  if (first_step_ >= c_.steps) {
    throw InputError(fmt::format("{}: the checkpoint is of step {}, this run ends at step {}; raise time.end",
                                 options_.restart.string(), first_step_, c_.steps));
  }
  std::string body;
  file.read("body", body);
  if (body != body_description(c_)) {
    throw InputError(fmt::format("{}: the checkpoint is of another body: {}; this run has {}",
                                 options_.restart.string(), body, body_description(c_)));
  }
  file.read("time_step", time_step);
  if (time_step != c_.time_step) {
    throw InputError(
        fmt::format("{}: the checkpoint was made with a time step of {} s, this run has {} s; set time.step",
                    options_.restart.string(), time_step, c_.time_step));
  }
  file.read("frame_phase", frame_phase);
  saved.frame_phase = static_cast<long>(frame_phase);
  file.read("wrapped", wrapped);
  saved.wrapped = wrapped != 0;
  file.read("first_kick_pending", pending);
  saved.first_kick_pending = pending != 0;
  for (std::size_t i = 0; i < 2; ++i) {
    file.read(fmt::format("external_work_{}", i), saved.external_work[i]);
    file.read(fmt::format("released_energy_{}", i), saved.released_energy[i]);
  }
  file.read("load_speed", saved.load_speed);
  file.read("vent", vent_now_);
  vent_next_ = vent_now_;
  file.read("first_bond_break", first_break);
  file.read("rupture_onset", onset);
  file.read("onset_displacement", onset_displacement);
  results_.first_bond_break_s = present(first_break);
  results_.rupture_onset_s = present(onset);
  results_.max_displacement_at_onset_m = present(onset_displacement);
  for (std::size_t k = 0; k < 3; ++k) {
    file.read(fmt::format("frame_{}", axes[k]), saved.frame[k]);
    file.read(fmt::format("displacement_{}", axes[k]), body_->layout(), saved.displacement[k]);
    file.read(fmt::format("leapfrog_velocity_{}", axes[k]), body_->layout(), saved.leapfrog_velocity[k]);
  }
  file.read("intact_bonds", word_block(*body_), saved.words);
  body_->restore(saved);
}

}  // namespace rhexis::app
