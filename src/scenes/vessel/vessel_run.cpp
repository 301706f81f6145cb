// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/vessel/vessel_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/format.hpp"
#include "core/stopwatch.hpp"
#include "coupling/network_load.hpp"
#include "hemodynamics/poiseuille.hpp"
#include "peridynamics/engine/bond_kernel.hpp"
#include "peridynamics/monitors/opening.hpp"
#include "peridynamics/simulation/equilibrium_start.hpp"
#include "runtime/interrupt.hpp"
#include "runtime/version.hpp"
#include "scenes/vessel/vessel_files.hpp"

namespace rhexis::scenes {
namespace {

struct UnstableError : RunError {
  using RunError::RunError;
};

/// A signal as a bit of what ranks tell each other after every step.
std::uint64_t flag_of_signal(int signal) {
  return signal == 0 ? 0 : std::uint64_t{1} << signal;
}

/// One of the signals that ranks have got, the same on all; 0 where there is none.
int signal_in(std::uint64_t flags) {
  return flags == 0 ? 0 : std::countr_zero(flags);
}

}  // namespace

VesselRun::VesselRun(VesselScene scene, runtime::RunOptions options, parallel::Communicator comm,
                     NetworkCoupling* coupling)
    : c_(std::move(scene)),
      comm_(comm),
      session_(describe(c_, c_.pictures, c_.output), std::move(options), comm,
               {[this] { return output::Values(results_); }, [this] { return work(); }}),
      coupling_(coupling) {}

VesselRun::~VesselRun() = default;

void VesselRun::prepare() {
  session_.open_folder(folder_plan(c_, session_.options()));
  build();
  if (!session_.options().restart.empty()) read_checkpoint();
}

runtime::Ending VesselRun::run() {
  if (!simulation_) prepare();
  const runtime::Ending ending = session_.recorded([&] {
    session_.start_pictures();
    open_results();
    print_header();
    if (c_.wall->parameters.equilibrium_pressure > 0 && session_.options().restart.empty())
      start_at_equilibrium();
    time_loop();
    warn_of_odd_openings();
    if (series_) series_->finish();
    if (coupling_ != nullptr) {
      coupling_->coupled().count_leak(simulation_->time());
      results_.coupling = coupling_->results();
    }
    session_.finish_pictures();
    session_.make_movie();
    return signal_;
  });
  print_summary();
  return ending;
}

void VesselRun::build() {
  simulation_ = std::make_unique<peridynamics::VesselSimulation>(*c_.wall, comm_);
  results_.family_max =
      peridynamics::largest_family(c_.wall->lattice(), c_.wall->families(), c_.wall->is_periodic());
  results_.time_step_s = c_.wall->time.step;
  results_.stable_time_step_s = c_.wall->time.stable;
  results_.particles = simulation_->particles();
  results_.bonds = simulation_->body().bonds();
  source_ = std::make_unique<peridynamics::ParticleSource>(simulation_->body());
  if (coupling_ != nullptr && coupling_->coupled().two_way()) {
    load_ = std::make_unique<coupling::NetworkLoad>(coupling_->coupled());
  } else if (c_.wall->parameters.venting != peridynamics::Venting::none) {
    load_ = std::make_unique<peridynamics::VentedLoad>(*c_.wall->parameters.supply_area);
  } else {
    load_ = std::make_unique<peridynamics::LoadSource>();
  }
  if (coupling_ == nullptr) return;
  coupling::NetworkLoad(coupling_->coupled()).start(*simulation_);
  results_.network = coupling_->network_record();
  results_.coupling = coupling_->results();
}

void VesselRun::open_results() {
  const bool restarts = !session_.options().restart.empty();
  if (restarts)
    session_.folder().will_write(files_of_steps(c_.output, first_step_, c_.wall->time.count, restarts));
  session_.open_record(restarts ? std::optional<std::int64_t>(first_step_) : std::nullopt);
  const std::filesystem::path history = session_.folder().claim("history.csv");
  if (restarts) {
    // The first moment is observed anew, so the row that the earlier run may have left of it goes.
    history_.emplace(history, comm_, first_step_ - 1);
  } else {
    history_.emplace(history, comm_);
  }
  if (coupling_ != nullptr) coupling_->open(session_.folder());
  if (c_.output.fields.empty()) return;
  output::PointSeriesPlan plan;
  plan.directory = session_.folder().path();
  plan.basename = series_name(first_step_, restarts);
  plan.title = c_.title;
  plan.version = runtime::version();
  plan.precision = c_.output.precision;
  plan.formats = output::formats_of(c_.output);
  for (const std::string& name : output::series_files(plan.basename, plan.formats))
    session_.folder().claim(name);
  plan.annotations = {"pressure"};
  for (const FieldInfo& field : peridynamics::ParticleSource::all_fields()) {
    if (std::find(c_.output.fields.begin(), c_.output.fields.end(), field.name) != c_.output.fields.end()) {
      plan.fields.push_back(field);
    }
  }
  plan.steps.push_back(first_step_);
  std::copy_if(c_.output_steps.begin(), c_.output_steps.end(), std::back_inserter(plan.steps),
               [&](long step) { return step > first_step_; });
  series_.emplace(plan, simulation_->body().layout(), comm_);
  series_->write_reference(source_->reference_positions());
}

runtime::Work VesselRun::work() const {
  return {.bond_evaluations = start_bond_evaluations_ + simulation_->body().bond_evaluations(),
          .flop_per_evaluation = 0.5 * peridynamics::flop_per_bond,
          .traffic = simulation_->body().traffic(),
          .network_flop = coupling_ != nullptr ? coupling_->flow().flop : std::nullopt};
}

bool VesselRun::output_due(long step) const {
  return std::ranges::binary_search(c_.output_steps, step);
}

bool VesselRun::pictures_due(long step, bool with_output) {
  if (!session_.pictures()->pipeline) return false;
  const bool due = c_.pictures.insitu.every_steps
                       ? step % *c_.pictures.insitu.every_steps == 0 || step == c_.wall->time.count
                       : with_output;
  // Scripts are asked last: the answer may need all ranks.
  return due && session_.pictures()->pipeline->wants(
                    step + session_.pictures()->steps_before,
                    simulation_->time_at(step) + session_.pictures()->seconds_before);
}

void VesselRun::start_at_equilibrium() {
  const Stopwatch watch(session_.spent().solve);
  const peridynamics::Equilibrium found = peridynamics::start_at_equilibrium(*simulation_, *c_.wall, comm_);
  start_bond_evaluations_ = found.bond_evaluations;
  session_.console().item(
      "start", fmt::format("equilibrium under {}: {} steps of relaxation, residual {:.1e}, strain energy {}",
                           quantity(c_.wall->parameters.equilibrium_pressure, "Pa"), found.steps,
                           found.residual, quantity(found.strain_energy, "J")));
}

void VesselRun::observe(long step, bool with_output, bool with_pictures) {
  peridynamics::Body& body = simulation_->body();
  const double pressure = simulation_->pressure(), time = simulation_->time();
  {
    const Stopwatch watch(session_.spent().solve);
    body.find_forces();  // once, for what is observed and for the next step
  }
  {
    const Stopwatch watch(with_output ? session_.spent().output : session_.spent().insitu);
    const peridynamics::Observation& observation = body.observe(pressure);
    source_->moment(step, time, observation, {{"pressure", "Pa", pressure}});
  }
  // A restart's first moment begins its own series of particles; in history.csv, which it continues, it would
  // be one row more than a run in one go has.
  if (with_output && (output_due(step) || signal_ != 0)) {
    const Stopwatch watch(session_.spent().output);
    const peridynamics::Totals t = body.totals();
    double& open_area = simulation_->load().open_area;
    // Beside a hole particles have lost about half of their bonds.
    open_area = t.max_damage >= peridynamics::rupture_damage ? simulation_->opening().area() : 0;
    const double leak = coupling_ != nullptr && coupling_->coupled().two_way()
                            ? coupling_->coupled().state().leak
                            : peridynamics::orifice_flow(c_.wall->parameters.discharge_coefficient, open_area,
                                                         pressure, c_.wall->parameters.blood_density);
    if (coupling_ != nullptr) results_.coupling = coupling_->results();
    results_.steps = step;
    results_.simulated_s = time;
    results_.max_displacement_m = t.max_displacement;
    results_.max_damage = t.max_damage;
    results_.rupture_length_m = t.rupture_length;
    results_.opening_area_m2 = open_area;
    check_balance(step, t);
    warn_of_crushed_bonds(step, t);
    const double energy = t.kinetic + t.strain + t.fracture;
    const double scale = std::max(std::abs(t.external_work), energy);
    results_.energy_drift = scale > 0 ? (energy - t.external_work) / scale : 0.0;
    session_.record().know(results_);
    history_->append({step, time, pressure, t.max_displacement, t.max_damage,
                      static_cast<long>(t.broken_bonds), t.kinetic, t.strain, t.external_work,
                      t.rupture_length, leak, t.fracture, open_area});
  }
  if (with_output && session_.options().on_output)
    session_.options().on_output(
        {.particles = &*source_, .network = coupling_ != nullptr ? &coupling_->lines() : nullptr});
  if (with_output && series_) {
    const Stopwatch watch(session_.spent().output);
    series_->write(*source_);
  }
  if (with_pictures) {
    const Stopwatch watch(session_.spent().insitu);
    runtime::LaterSource particles(*source_, *session_.pictures());
    session_.pictures()->process(
        {.particles = &particles, .network = coupling_ != nullptr ? &coupling_->lines() : nullptr});
  }
}

/// Observes the moment at hand. Where that can be stored or drawn no longer, the state is saved, if it can
/// be.
void VesselRun::show(bool with_output, bool with_pictures) {
  try {
    observe(step(), with_output, with_pictures);
  } catch (const UnstableError&) {  // a state of no use
    throw;
  } catch (const RunError&) {
    // A restart exchanges anew at its first step.
    const bool has_exchanged = coupling_ != nullptr && coupling_->coupled().due(step());
    try {
      if (!has_exchanged) write_checkpoint(step());
      if (!last_checkpoint_.empty())
        session_.console().important(
            fmt::format("  failed; go on with --restart {}", last_checkpoint_.string()));
    } catch (const RunError& also) {
      session_.warn(std::string("no checkpoint: ") + also.what());
    }
    throw;
  }
}

/// The opening is measured between particles, wherever they have gone.
void VesselRun::warn_of_odd_openings() {
  if (!results_.rupture_onset_s) return;
  const peridynamics::Parameters& v = c_.wall->parameters;
  const double wall = 2 * std::numbers::pi * v.inner_radius * v.length;
  const double open_area = simulation_->load().open_area;
  if (open_area > wall) {
    session_.warn(
        fmt::format("the opening at the end, {:.3g} mm2, is larger than the lumen's surface of the simulated "
                    "wall, {:.3g} mm2: fragments have flown apart, and it is no hole in a wall any more",
                    1e6 * open_area, 1e6 * wall));
  }
  if (v.venting == peridynamics::Venting::orifice && simulation_->load().least_share == 1 &&
      *results_.rupture_length_m > 0.9 * v.length) {
    session_.warn(
        "the wall is ruptured over its length, but no row of it ever showed a gap, so the load was not "
        "vented: a wall that tears all around at once counts as open late, or never");
  }
}

std::string VesselRun::unstable_message(long step, const std::string& sign) const {
  return fmt::format(
      "the run became unstable by step {} ({}): {}; use a smaller time.step (now {}; {} is stable "
      "while strains are small)",
      step, quantity(simulation_->time_at(step), "s"), sign, quantity(c_.wall->time.step, "s"),
      quantity(c_.wall->time.stable, "s"));
}

void VesselRun::check_balance(long step, const peridynamics::Totals& t) const {
  // Leapfrog's velocity is half a step ahead of the work: after one step of a ramp from zero it is all there
  // is.
  if (step < 2 || peridynamics::holds_no_more_than_was_put_in(t)) return;
  throw UnstableError(unstable_message(step, "the wall holds more energy than the load has put in"));
}

/// 1, 2, 4, ... steps after the first break: a wall that an unstable step tears is not to pass for a rupture
/// until the next output.
bool VesselRun::balance_due(long step) const {
  if (!results_.first_bond_break_s) return false;
  const long since = step - std::lround(*results_.first_bond_break_s / c_.wall->time.step);
  return since > 0 && std::has_single_bit(static_cast<unsigned long>(since));
}

/// Once: such bonds cost accuracy, which the balance of energy shows, before they cost stability.
void VesselRun::warn_of_crushed_bonds(long step, const peridynamics::Totals& t) {
  if (t.crushed_bonds == 0 || crushing_was_told_) return;
  crushing_was_told_ = true;
  session_.warn(
      fmt::format("at {} {} bonds are compressed to less than half their length, where {} is no longer known "
                  "to be stable: the run will stop if energy exceeds the work done by a tenth; a smaller "
                  "time.step is safer",
                  quantity(simulation_->time_at(step), "s"), grouped(t.crushed_bonds),
                  quantity(c_.wall->time.step, "s")));
}

/// Tells of what a step, or the end, has shown.
void VesselRun::record_events(const peridynamics::VesselSimulation::Report& report) {
  if (report.unstable)
    throw UnstableError(unstable_message(step(), "a particle outran what the load can do"));
  const peridynamics::RuptureEvents& rupture = simulation_->rupture();
  results_.first_bond_break_s = rupture.first_break;
  results_.rupture_onset_s = rupture.onset;
  results_.pressure_at_onset_Pa = rupture.pressure;
  results_.blood_pressure_at_onset_Pa = rupture.blood_pressure;
  results_.max_displacement_at_onset_m = rupture.max_displacement;
  if (!report.ruptures) return;
  session_.console().line(
      fmt::format("  rupture begins at {} under {} on the reference area (a blood pressure of {}), largest "
                  "displacement {}",
                  quantity(*rupture.onset, "s"), quantity(*rupture.pressure, "Pa"),
                  quantity(*rupture.blood_pressure, "Pa"), quantity(*rupture.max_displacement, "m", 3)));
}

/// Once.
void VesselRun::warn_of_turbulence() {
  if (coupling_ == nullptr || !coupling_->coupled().due(step())) return;
  if (!results_.rupture_onset_s || turbulence_was_told_) return;
  const double reynolds = coupling_->coupled().state().highest_reynolds;
  if (reynolds <= hemodynamics::laminar_reynolds_number) return;
  turbulence_was_told_ = true;
  session_.warn(
      fmt::format("at {} the Reynolds number in the torn vessel has reached {:.0f}; above {:.0f} flow is not "
                  "laminar: real resistances are higher than those of Eq. (9), and less leaks",
                  quantity(simulation_->time(), "s"), reynolds, hemodynamics::laminar_reynolds_number));
}

void VesselRun::time_loop() {
  const runtime::InterruptGuard guard;
  peridynamics::Body& body = simulation_->body();
  for (;;) {
    const long now = step();
    const bool due = output_due(now) || now == first_step_ || signal_ != 0;
    const bool pictures = pictures_due(now, due);
    const bool saves =
        c_.output.checkpoint_every > 0 && now > first_step_ && now % c_.output.checkpoint_every == 0;
    // First of all, because a launcher that was interrupted may not leave time for more.
    if (signal_ != 0 || saves) write_checkpoint(now);
    {
      const Stopwatch watch(session_.spent().solve);
      load_->at_moment(*simulation_);
    }
    warn_of_turbulence();
    if (due || pictures) show(due, pictures);
    if (!due && balance_due(now)) {
      const Stopwatch watch(session_.spent().solve);
      body.observe(simulation_->pressure());
      check_balance(now, body.totals());
    }
    session_.console().progress(now, c_.wall->time.count,
                                fmt::format("t {}  P {}", quantity(simulation_->time(), "s", 3),
                                            quantity(simulation_->pressure(), "Pa", 3)));
    if (signal_ != 0 || now == c_.wall->time.count) {
      record_events(simulation_->conclude(body.totals()));
      return;
    }
    const Stopwatch watch(session_.spent().solve);
    const auto report = simulation_->step(*load_, flag_of_signal(runtime::InterruptGuard::requested()));
    record_events(report);
    if (now + 1 < c_.wall->time.count) signal_ = signal_in(report.flags);  // after the last step it is done
  }
}

runtime::Ending run(VesselScene scene, const runtime::RunOptions& options, parallel::Communicator comm) {
  return VesselRun(std::move(scene), options, comm).run();
}

}  // namespace rhexis::scenes
