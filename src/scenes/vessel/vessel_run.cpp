// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/vessel/vessel_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>

#include "core/error.hpp"
#include "core/format.hpp"
#include "core/stopwatch.hpp"
#include "peridynamics/engine/bond_kernel.hpp"
#include "peridynamics/simulation/energy_balance.hpp"
#include "peridynamics/simulation/equilibrium_start.hpp"
#include "peridynamics/simulation/rupture_observer.hpp"
#include "peridynamics/simulation/time_loop.hpp"
#include "runtime/interrupt.hpp"
#include "runtime/picture_observer.hpp"
#include "runtime/progress_observer.hpp"
#include "runtime/version.hpp"
#include "scenes/vessel/vessel_files.hpp"
#include "studies/rupture/history_observer.hpp"

namespace rhexis::scenes {
namespace {

/// Calls a function at `steps` (ascending) and at the end, and where asked at the first moment too.
class CallAtSteps final : public Observer {
 public:
  CallAtSteps(std::span<const long> steps, bool at_first, std::function<void(const Moment&)> call)
      : steps_(steps), at_first_(at_first), call_(std::move(call)) {}
  bool wants(const Moment& moment) override {
    return moment.last || (at_first_ && moment.first) || std::ranges::binary_search(steps_, moment.step);
  }
  void observe(const Moment& moment) override { call_(moment); }

 private:
  std::span<const long> steps_;
  bool at_first_;
  std::function<void(const Moment&)> call_;
};

}  // namespace

VesselRun::VesselRun(VesselScene scene, runtime::RunOptions options, parallel::Communicator comm,
                     HostNetwork* network)
    : c_(std::move(scene)),
      comm_(comm),
      session_(describe(c_, c_.pictures, c_.output), std::move(options), comm,
               {[this] { return output::Values(results_so_far()); }, [this] { return work(); }}),
      network_(network) {}

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
    if (network_ != nullptr) {
      network_->finish(simulation_->time());
      results_.coupling = network_->results();
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
  results_.family_max = peridynamics::count_bonds(*c_.wall).largest_family;
  results_.time_step_s = c_.wall->time.step;
  results_.stable_time_step_s = c_.wall->time.stable;
  results_.particles = simulation_->particles();
  results_.bonds = simulation_->body().bonds();
  if (network_ != nullptr) load_ = network_->load();
  if (!load_ && c_.wall->parameters.venting != peridynamics::Venting::none)
    load_ = std::make_unique<peridynamics::VentedLoad>(*c_.wall->parameters.supply_area);
  if (!load_) load_ = std::make_unique<peridynamics::LoadSource>();
  if (network_ == nullptr) return;
  network_->start(*simulation_);
  results_.network = network_->network_record();
  results_.coupling = network_->results();
}

void VesselRun::open_results() {
  const bool restarts = session_.restarts();
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
  if (network_ != nullptr) network_->open(session_.folder());
  if (const auto plan = series_plan()) {
    peridynamics::ParticleSource& particles = simulation_->particle_source();
    fields_.emplace(*plan, particles, particles.reference_positions(), comm_);
  }
}

/// What is stored of the particles' fields; none where that is nothing.
std::optional<output::PointSeriesPlan> VesselRun::series_plan() {
  if (c_.output.fields.empty()) return {};
  output::PointSeriesPlan plan;
  plan.directory = session_.folder().path();
  plan.basename = series_name(first_step_, session_.restarts());
  plan.title = c_.title;
  plan.version = runtime::version();
  plan.precision = c_.output.precision;
  plan.formats = output::formats_of(c_.output);
  for (const std::string& name : output::series_files(plan.basename, plan.formats))
    session_.folder().claim(name);
  plan.annotations = {"pressure"};
  for (const FieldInfo& field : peridynamics::ParticleSource::all_fields()) {
    if (std::ranges::find(c_.output.fields, field.name) != c_.output.fields.end())
      plan.fields.push_back(field);
  }
  plan.steps.push_back(first_step_);
  std::ranges::copy_if(c_.output_steps, std::back_inserter(plan.steps),
                       [&](long step) { return step > first_step_; });
  return plan;
}

runtime::Work VesselRun::work() const {
  return {.bond_evaluations = start_bond_evaluations_ + simulation_->body().bond_evaluations(),
          .flop_per_evaluation = peridynamics::flop_per_evaluation(*c_.wall),
          .traffic = simulation_->body().traffic(),
          .network_flop = network_ != nullptr ? network_->flop() : std::nullopt};
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

/// What run.json tells of the latest output.
void VesselRun::note_results(const Moment& moment) {
  const peridynamics::Totals& t = simulation_->totals();
  if (network_ != nullptr) results_.coupling = network_->results();
  results_.steps = moment.step;
  results_.simulated_s = moment.time_s;
  results_.max_displacement_m = t.max_displacement;
  results_.max_damage = t.max_damage;
  results_.rupture_length_m = t.rupture_length;
  results_.opening_area_m2 = simulation_->open_area();
  const double energy = t.kinetic + t.strain + t.fracture;
  const double scale = std::max(std::abs(t.external_work), energy);
  results_.energy_drift = scale > 0 ? (energy - t.external_work) / scale : 0.0;
  session_.record().know(results_so_far());
}

/// The latest output's, with what is known of the rupture by now.
Results VesselRun::results_so_far() const {
  Results results = results_;
  if (!simulation_) return results;
  const peridynamics::RuptureEvents& rupture = simulation_->rupture();
  results.first_bond_break_s = rupture.first_break;
  results.rupture_onset_s = rupture.onset;
  results.pressure_at_onset_Pa = rupture.pressure;
  results.blood_pressure_at_onset_Pa = rupture.blood_pressure;
  results.max_displacement_at_onset_m = rupture.max_displacement;
  return results;
}

/// The opening is measured between particles, wherever they have gone.
void VesselRun::warn_of_odd_openings() {
  if (!simulation_->rupture().onset) return;
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

void VesselRun::time_loop() {
  const runtime::InterruptGuard guard;
  runtime::Spent& spent = session_.spent();
  const std::span<const long> steps = c_.output_steps;
  const long last_step = c_.wall->time.count;
  const auto warn = [&](const std::string& text) { session_.warn(text); };

  peridynamics::RuptureObserver rupture(*simulation_, [&](const auto& events) { print_onset(events); });
  output::CheckpointObserver checkpoints(checkpoint_plan());
  runtime::ProgressObserver progress(session_.console(), last_step, [&] {
    return fmt::format("t {}  P {}", quantity(simulation_->time(), "s", 3),
                       quantity(simulation_->pressure(), "Pa", 3));
  });
  CallAtSteps results(steps, false, [&](const Moment& moment) { note_results(moment); });
  peridynamics::EnergyBalance balance(*simulation_, steps);
  peridynamics::CrushedBonds crushed(*simulation_, steps, given_warnings_.crushed_bonds, warn);
  studies::HistoryObserver history(*simulation_, *load_, std::move(*history_), steps);
  const auto channels = [&] {
    insitu::Channels shown{{"particles", &simulation_->particle_source()}};
    if (network_ != nullptr)
      shown.push_back({"network", &network_->lines(simulation_->step_number(), simulation_->time())});
    return shown;
  };
  CallAtSteps caller(steps, true, [&](const Moment&) { session_.options().on_output(channels()); });
  runtime::PictureObserver pictures(
      *session_.pictures(),
      {.every_steps = c_.pictures.insitu.every_steps, .output_steps = steps, .channels = channels});

  peridynamics::TimeLoop loop(*simulation_, *load_,
                              {.steps = last_step, .signal = runtime::InterruptGuard::requested});
  loop.count_solving(spent.solve);
  loop.subscribe(rupture);
  loop.subscribe(checkpoints, &spent.output);
  loop.subscribe(progress);
  std::unique_ptr<Observer> turbulence;
  if (network_ != nullptr) {
    turbulence = network_->observer(*simulation_, given_warnings_.turbulence, warn);
    loop.subscribe(*turbulence);
  }
  loop.subscribe(results, &spent.output);
  loop.subscribe(balance, &spent.solve);
  loop.subscribe(crushed);
  loop.subscribe(history, &spent.output);
  if (session_.options().on_output) loop.subscribe(caller);
  if (fields_) loop.subscribe(*fields_, &spent.output);
  loop.subscribe(pictures, &spent.insitu);
  signal_ = loop.run();
  results_ = results_so_far();
}

runtime::Ending run(VesselScene scene, const runtime::RunOptions& options, parallel::Communicator comm) {
  return VesselRun(std::move(scene), options, comm).run();
}

}  // namespace rhexis::scenes
