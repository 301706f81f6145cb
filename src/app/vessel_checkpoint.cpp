// Checkpoints of a vessel's run: what they hold, and going on from one.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "app/folder_plan.hpp"
#include "app/stopwatch.hpp"
#include "app/vessel_run.hpp"
#include "core/error.hpp"
#include "core/format.hpp"
#include "input/catalogue.hpp"
#include "input/difference.hpp"
#include "output/checkpoint.hpp"

namespace rhexis::app {
namespace {

constexpr const char* axes[] = {"x", "y", "z"};

output::WordBlock word_block(const peridynamics::Body& body) {
  const peridynamics::BondWordLayout l = body.bond_word_layout();
  return {l.rows, l.words, l.first_row, l.row_count, l.first_word, l.word_count};
}

/// The sections that make a body what it is: a checkpoint can only be restored to the same.
bool of_the_body(const std::string& key) {
  constexpr std::array sections = {"vessel", "material", "scatter", "spot", "discretisation", "boundary"};
  return std::ranges::find(sections, input::section_of(input::without_table(key))) != sections.end();
}

/// The sections that say what happens to a body; the others say how long, and what is shown.
bool of_its_load(const std::string& key) {
  constexpr std::array others = {"scene", "time", "output", "insitu", "network", "screening"};
  return !of_the_body(key) && std::ranges::find(others, input::section_of(key)) == others.end();
}

/// What a network may say of a body, as a record of input has it.
nlohmann::ordered_json measures(const peridynamics::Parameters& v) {
  const auto entry = [](double value, const std::string& written) {
    return nlohmann::ordered_json{{"written", written}, {"value", value}};
  };
  return {{"vessel",
           {{"inner_radius", entry(v.inner_radius, quantity(v.inner_radius, "m"))},
            {"outer_radius", entry(v.outer_radius, quantity(v.outer_radius, "m"))},
            {"length", entry(v.length, quantity(v.length, "m"))}}},
          {"material", {{"critical_stretch", entry(*v.critical_stretch, text(*v.critical_stretch))}}}};
}

/// A number that may be absent, as checkpoints store it: times and lengths here are never negative.
constexpr double absent = -1;

std::optional<double> present(double stored) {
  return stored >= 0 ? std::optional<double>(stored) : std::nullopt;
}

}  // namespace

void VesselRun::write_checkpoint(long step) {
  if (!c_.coupling.restartable()) return;  // asked for by an interrupt
  const Stopwatch watch(spent_.output);
  const peridynamics::Body::Saved saved = body_->save();
  const std::filesystem::path path = folder_->claim(checkpoint_name(step));
  output::CheckpointWriter file(path, comm_);
  file.write("step", std::int64_t{step});
  file.write("input", c_.record.dump());
  file.write("measures", measures(c_.vessel).dump());
  file.write("pressure", pressure_at(step));
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
  file.write("onset_pressure", results_.pressure_at_onset_Pa.value_or(absent));
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

/// Refuses the checkpoint of another body; warns of what else happens to it from now on than before.
void VesselRun::compare_with(output::CheckpointReader& file) {
  using Json = nlohmann::ordered_json;
  const auto read = [&](const std::string& name) {
    std::string record;
    file.read(name, record);
    return Json::parse(record);
  };
  const Json input = read("input");
  auto of_body = input::differences(input, c_.record, of_the_body);
  if (of_body.empty()) of_body = input::differences(read("measures"), measures(c_.vessel), of_the_body);
  if (!of_body.empty()) {
    throw InputError(fmt::format("{}: the checkpoint is of another body: {}", options_.restart.string(),
                                 of_body.front().text));
  }
  for (const input::Difference& d : input::differences(input, c_.record, of_its_load))
    c_.warnings.push_back(fmt::format("{}, from step {} on", d.text, first_step_));
  double pressure = 0;
  file.read("pressure", pressure);
  if (pressure != pressure_at(first_step_)) {
    c_.warnings.push_back(fmt::format("the schedule had {} at step {}, and now has {}",
                                      quantity(pressure, "Pa"), first_step_,
                                      quantity(pressure_at(first_step_), "Pa")));
  }
}

void VesselRun::read_checkpoint() {
  output::CheckpointReader file(options_.restart, comm_);
  peridynamics::Body::Saved saved = body_->save();
  double time_step = 0, onset = absent, first_break = absent, onset_displacement = absent,
         onset_pressure = absent;
  std::int64_t pending = 0, step = 0, frame_phase = 0, wrapped = 0;
  file.read("step", step);
  first_step_ = static_cast<long>(step);
  if (first_step_ >= c_.steps) {
    throw InputError(fmt::format("{}: the checkpoint is of step {}, this run ends at step {}; raise time.end",
                                 options_.restart.string(), first_step_, c_.steps));
  }
  compare_with(file);
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
  file.read("onset_pressure", onset_pressure);
  file.read("onset_displacement", onset_displacement);
  results_.first_bond_break_s = present(first_break);
  results_.rupture_onset_s = present(onset);
  results_.pressure_at_onset_Pa = present(onset_pressure);
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
