// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/coupled/cascade_run.hpp"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/format.hpp"
#include "core/stopwatch.hpp"
#include "output/atomic_file.hpp"
#include "parallel/together.hpp"
#include "runtime/run_session.hpp"
#include "runtime/version.hpp"
#include "scenes/checkpoint_input.hpp"
#include "scenes/coupled/coupled_files.hpp"
#include "scenes/coupled/network_coupling.hpp"
#include "scenes/results.hpp"
#include "scenes/vessel/vessel_run.hpp"
#include "studies/cascade/cascade_state.hpp"

namespace rhexis::scenes {
namespace {

class CascadeRun {
 public:
  CascadeRun(CoupledScene scene, const runtime::RunOptions& options, parallel::Communicator comm)
      : scene_(std::move(scene)),
        comm_(comm),
        session_(describe(scene_, scene_.pictures, scene_.output), options, comm,
                 {[this] { return output::Values(results_); }, [] { return runtime::Work{}; }}) {}

  runtime::Ending run() {
    if (session_.restarts()) read_checkpoint();
    // What the input is warned of is told once, not by every event.
    const std::vector<std::string> warnings = std::exchange(scene_.warnings, {});
    session_.print_title();
    open_cascade_folder();
    if (!state_.events.empty()) scene_.coupling.vessel = "screening";
    solve_network();
    if (!network_->at_rest() && !all_simulated()) next_ = network_->make_vessel();
    if (restarts_within_event_) prepare_interrupted_event();
    const runtime::Ending ending = session_.recorded([&] {
      session_.start_pictures();
      session_.open_record();
      session_.warn(warnings);
      results_.cascade = nlohmann::ordered_json::array();
      if (!state_.events.empty()) write_table();
      return simulate_events();
    });
    print_summary(ending.interrupted() ? runtime::interrupted_by(ending.signal)
                  : network_->at_rest()
                      ? fmt::format("no other vessel's risk is above {}", text(scene_.coupling.risk_limit))
                      : "after cascade.events");
    return ending;
  }

 private:
  bool all_simulated() const {
    return static_cast<std::int64_t>(state_.events.size()) >= scene_.coupling.events;
  }

  /// All events that are left, to the end of the cascade or an interrupt; returns its signal, or 0.
  int simulate_events() {
    std::string obstacle;  // to the next event
    runtime::Ending last;
    const auto goes_on = [&] {
      return obstacle.empty() && !network_->at_rest() && !last.interrupted() && !all_simulated();
    };
    while (goes_on()) {
      last = simulate();
      if (!last.interrupted()) write_checkpoint();
      write_table();
      scene_.coupling.vessel = "screening";
      solve_network();
      if (!last.interrupted()) write_checkpoint();
      write_table();
      if (!goes_on()) break;
      try {
        next_ = network_->make_vessel();
      } catch (const InputError& error) {
        obstacle = fmt::format("event {} cannot be simulated: {}", state_.events.size() + 1, error.what());
      }
    }
    results_.network = network_->network_record();
    network_->write(session_.folder());
    session_.finish_pictures();
    session_.make_movie();
    if (!obstacle.empty()) throw RunError(obstacle);
    return last.signal;
  }

  /// The events so far, and whether another one was going on.
  void read_checkpoint() {
    output::CheckpointReader file(session_.options().restart, comm_);
    if (!file.holds(studies::cascade_name))
      file.refuse("the checkpoint is not of a cascade, as cascade.events asks for");
    state_ = studies::read_cascade(file);
    restarts_within_event_ = file.holds(step_name);
    if (restarts_within_event_ && all_simulated()) {
      file.refuse(fmt::format("the checkpoint is of event {}, but cascade.events = {}",
                              state_.events.size() + 1, scene_.coupling.events));
    }
    // Within an event its run compares, and tells.
    if (!restarts_within_event_)
      compare_input(file, scene_, nullptr, fmt::format("event {}", state_.events.size() + 1));
  }

  /// With what the events so far left.
  void solve_network() {
    network_.reset();
    network_.emplace(scene_, &state_, reading_for_a_run(comm_, session_.console()), session_.console());
    if (!state_.events.empty()) note_what_followed();
  }

  /// The checkpoint is read before anything is written.
  void prepare_interrupted_event() {
    if (network_->at_rest())
      throw InputError(session_.options().restart.string() +
                       ": the network is not as it was: no vessel is at risk now");
    interrupted_event_ =
        std::make_unique<VesselRun>(next_, event_options(session_.options().restart), comm_, &*network_);
    interrupted_event_->prepare();
  }

  runtime::RunOptions event_options(const std::filesystem::path& restart) const {
    runtime::RunOptions options = session_.options();
    options.folder = session_.folder().subfolder(event_name(state_.events.size() + 1));
    options.directory = options.folder->path();
    options.restart = restart;
    options.started = seconds_now();
    options.pictures = session_.pictures();
    return options;
  }

  /// What came after the checkpoint is no part of this cascade.
  void open_cascade_folder() {
    output::FolderPlan plan = folder_plan(scene_, session_.options());
    const std::size_t done = state_.events.size();
    for (std::size_t event = done + 1; event <= static_cast<std::size_t>(scene_.coupling.events); ++event)
      plan.writes.names.push_back(event_checkpoint_name(event));
    if (session_.restarts()) {
      const std::size_t kept = done + (restarts_within_event_ ? 1 : 0);
      plan.drops = [kept](const std::string& name) { return event_number(name) > kept; };
    }
    session_.open_folder(plan);
  }

  runtime::Ending simulate() {
    const hemodynamics::NetworkVessel vessel = network_->chosen();
    session_.console().line(fmt::format("Event {}: vessel {}, risk {:.3f}", state_.events.size() + 1,
                                        vessel.name, network_->risk()));
    session_.pictures()->steps_before = state_.steps_before;
    session_.pictures()->seconds_before = state_.elapsed;
    const double pressure = network_->coupled().intact_pressure();
    std::unique_ptr<VesselRun> run = std::exchange(interrupted_event_, nullptr);
    if (!run) run = std::make_unique<VesselRun>(next_, event_options({}), comm_, &*network_);
    const runtime::Ending ending = run->run();
    session_.spent().add(run->spent());
    const Results& r = run->results();
    studies::CascadeEvent event{.vessel = vessel,
                                .risk = network_->risk(),
                                .net_pressure = pressure,
                                .ruptured = r.rupture_onset_s.has_value(),
                                .rupture_onset = r.rupture_onset_s,
                                .opening = r.opening_area_m2.value_or(0),
                                .inflow_before = network_->flow().inflow};
    // An interrupted wall might have torn yet.
    if (ending.interrupted() && !r.rupture_onset_s) event.ruptured.reset();
    std::optional<hemodynamics::VesselFailure> failure;
    if (r.rupture_onset_s) {
      event.time = state_.elapsed + *r.rupture_onset_s;
      failure = {static_cast<std::uint32_t>(vessel.vessel),
                 scene_.coupling.outcome == coupling::Outcome::occlusion,
                 network_->coupled().orifice(event.opening)};
    }
    state_.record(std::move(event), failure, r.simulated_s.value_or(0), r.steps.value_or(0) + 1);
    return ending;
  }

  /// The last event is told whole when the network has been solved with what it left. A checkpoint that knows
  /// must know the same: throws InputError.
  void note_what_followed() {
    parallel::on_root<InputError>(comm_, [&] {
      studies::CascadeEvent& event = state_.events.back();
      if (event.inflow_after && !coupling::agree(*event.inflow_after, network_->flow().inflow)) {
        throw InputError(fmt::format(
            "{}: the network is not as it was: after event {} its inflow was {} m3/s, and now is {} m3/s",
            session_.options().restart.string(), state_.events.size(), *event.inflow_after,
            network_->flow().inflow));
      }
      event.inflow_after = network_->flow().inflow;
      if (event.ruptured == true && !network_->flow().leaks.empty())
        event.leak = network_->flow().leaks.back();
      if (network_->risk() <= 0) return;
      event.next_vessel = network_->chosen().name;
      event.next_risk = network_->risk();
    });
  }

  /// Between events, so that nothing is lost if the run ends before the next one.
  void write_checkpoint() {
    const Stopwatch watch(session_.spent().output);
    output::CheckpointWriter file(session_.folder().claim(event_checkpoint_name(state_.events.size())),
                                  runtime::version(), comm_);
    write_input(file, scene_, nullptr);
    studies::save_cascade(state_, comm_, file);
    file.close();
  }

  /// One row for each event, also in run.json.
  void write_table() {
    results_.simulated_s = state_.elapsed;
    results_.cascade = nlohmann::ordered_json::array();
    for (const studies::CascadeEvent& event : state_.events)
      results_.cascade.push_back(studies::to_json(event, results_.cascade.size() + 1));
    const std::filesystem::path path = session_.folder().claim(cascade_table_name);
    parallel::on_root<RunError>(
        comm_, [&] { output::write_atomically(path, studies::cascade_table(state_.events)); });
  }

  void print_summary(const std::string& why_ended) {
    runtime::Console& console = session_.console();
    console.line("Cascade:");
    for (std::size_t i = 0; i < state_.events.size(); ++i) {
      const studies::CascadeEvent& e = state_.events[i];
      const std::string outcome =
          e.ruptured == true
              ? fmt::format("ruptured at {}, inflow {:.4g} to {:.4g} mL/min",
                            quantity(e.time.value_or(0), "s"), 1e3 * litres_per_minute * e.inflow_before,
                            1e3 * litres_per_minute * e.inflow_after.value_or(0))
          : e.ruptured == false ? "held"
                                : "interrupted";
      console.item(fmt::format("event {}", i + 1),
                   fmt::format("{}, risk {:.3f}: {}", e.vessel.name, e.risk, outcome));
    }
    console.item("ended", why_ended);
    session_.print_cost(session_.performance());
  }

  CoupledScene scene_;  ///< with the warnings moved to the run; its vessel is chosen by risk after the first
  parallel::Communicator comm_;
  Results results_;
  runtime::RunSession session_;
  studies::CascadeState state_;  ///< without what the first rank alone knows of vessels on the others
  std::optional<NetworkCoupling> network_;
  VesselScene next_;  ///< the event after those so far
  bool restarts_within_event_ = false;
  std::unique_ptr<VesselRun> interrupted_event_;
};

}  // namespace

runtime::Ending run_cascade(CoupledScene scene, const runtime::RunOptions& options,
                            parallel::Communicator comm) {
  return CascadeRun(std::move(scene), options, comm).run();
}

}  // namespace rhexis::scenes
