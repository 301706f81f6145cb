// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/coupled/network_coupling.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numeric>

#include "core/error.hpp"
#include "core/format.hpp"
#include "core/stopwatch.hpp"
#include "coupling/network_load.hpp"
#include "coupling/turbulence_observer.hpp"
#include "scenes/network/network_report.hpp"
#include "studies/flow/network_record.hpp"

namespace rhexis::scenes {
namespace {

studies::ScreeningPlan plan_screening(const CoupledScene& s, const studies::CascadeState* cascade) {
  return screening_plan(s.network, coupling::outside_everywhere(s.coupling),
                        cascade != nullptr ? cascade->simulated : std::vector<std::uint32_t>{});
}

}  // namespace

NetworkCoupling::NetworkCoupling(const CoupledScene& scene, const studies::CascadeState* cascade,
                                 const Reading& reading, runtime::Console& console)
    : scene_(scene),
      cascade_(cascade),
      reading_(reading),
      problem_(scene.network.problem),
      screening_(plan_screening(scene, cascade)) {
  const Stopwatch watch(network_s_);
  if (cascade_ != nullptr) problem_.failures = cascade_->failures;
  solver_ = with_place(scene_, [&] { return hemodynamics::prepared_solver(problem_, reading_.comm); });
  find_named_vessel();
  if (problem_.failures.empty()) {
    print_source(console, *solver_);
    append(scene_.warnings, warnings_of(*solver_));
  } else {
    console.item("network", solver_->description());
  }
  network_ = studies::solve_network(
      *solver_, problem_, screening_, [&](const std::string& text) { console.line(text); }, reading_.comm);
  append(scene_.warnings, network_.solution.warnings);
  choose();
}

/// Looks for what the input names before anything is solved. Throws InputError, complete with place.
void NetworkCoupling::find_named_vessel() {
  if (cascade_ != nullptr && !cascade_->simulated.empty()) {
    const std::int64_t vessels = solver_->vessels();
    for (const std::uint32_t v : cascade_->simulated) {
      if (v >= vessels)
        throw InputError("--restart: the network has fewer vessels than when the checkpoint was written");
    }
  }
  if (!scene_.coupling.screens())
    named_ = with_place(scene_, [&] { return solver_->find(scene_.coupling.vessel, "coupling.vessel"); });
}

/// The vessel whose wall is simulated. A cascade comes to rest when there is none.
void NetworkCoupling::choose() {
  if (named_) {
    chosen_ = solver_->vessel(*named_);
    chosen_.name = scene_.coupling.vessel;
  } else if (!network_.screened->at_risk.empty()) {
    chosen_ = network_.screened->at_risk.front();
  } else if (scene_.coupling.events == 0) {
    throw input::located(InputError("no vessel's wall is under tension", "coupling.vessel"), scene_.resolved);
  }
  coupling::set_radius(chosen_, scene_.coupling.radius_of);
  if (chosen_.radius > 0) {
    risk_ = screening::risk(screening_.criterion, std::midpoint(chosen_.pressure_from, chosen_.pressure_to),
                            chosen_.wall_thickness / chosen_.radius, {chosen_.strength_factor, 1});
  }
  at_rest_ = scene_.coupling.events > 0 && scene_.coupling.screens() && !(risk_ > scene_.coupling.risk_limit);
}

VesselScene NetworkCoupling::make_vessel() {
  VesselScene vessel = vessel_of(scene_);
  with_place(scene_, [&] {
    coupled_.emplace(scene_.coupling, problem_, vessel.vessel.discharge_coefficient, *solver_,
                     network_.solution.display, chosen_, reading_.comm, vessel.warnings);
    vessel.vessel = coupled_->extract_wall(scene_.vessel);
  });
  resolve_coupled_wall(vessel, reading_);
  with_place(scene_, [&] {
    coupled_->set_windows(vessel.wall->parameters, vessel.wall->time.step, vessel.warnings);
  });
  return vessel;
}

void NetworkCoupling::write(const output::ResultsFolder& folder) {
  studies::write_network(network_files_plan(scene_, scene_.network, scene_.output), network_, folder,
                         reading_.comm);
}

void NetworkCoupling::open(const output::ResultsFolder& folder) {
  write(folder);
  coupled_->open_table(folder);
}

std::unique_ptr<peridynamics::LoadSource> NetworkCoupling::load() {
  if (!coupled_->two_way()) return nullptr;
  return std::make_unique<coupling::NetworkLoad>(*coupled_);
}

void NetworkCoupling::start(peridynamics::VesselSimulation& simulation) {
  coupling::NetworkLoad(*coupled_).start(simulation);
}

std::unique_ptr<Observer> NetworkCoupling::observer(const peridynamics::VesselSimulation& simulation,
                                                    bool& told,
                                                    std::function<void(const std::string&)> warn) {
  return std::make_unique<coupling::TurbulenceObserver>(simulation, *coupled_, told, std::move(warn));
}

void NetworkCoupling::save(output::CheckpointWriter& file) const {
  coupled_->save(file, flow().inflow);
  if (cascade_ != nullptr) studies::save_cascade(*cascade_, reading_.comm, file);
}

void NetworkCoupling::restore(output::CheckpointReader& file, double time_s,
                              const std::filesystem::path& directory) {
  const bool is_cascade = cascade_ != nullptr;
  if (!file.holds(coupling::coupled_vessel_name))
    file.refuse("the checkpoint is not of a vessel that is coupled with a network");
  if (file.holds(studies::cascade_name) != is_cascade)
    file.refuse(is_cascade ? "the checkpoint is not of a cascade, as cascade.events asks for"
                           : "the checkpoint is of a cascade's event; set cascade.events");
  coupled_->restore(file, flow().inflow, is_cascade, time_s, directory);
}

LineSource& NetworkCoupling::lines(long step, double time_s) {
  std::vector<Annotation> notes{
      {"vessels", "1", static_cast<double>(flow().vessels)},
      {"shown", "1", static_cast<double>(network_.solution.display.shown)},
      {"inflow", "m3/s", flow().inflow},
      {"leak", "m3/s", coupled_->state().leak},
      {"event", "1", cascade_ != nullptr ? static_cast<double>(cascade_->events.size() + 1) : 0.0}};
  if (chosen_.start) {
    constexpr const char* names[] = {"chosen_start_x", "chosen_start_y", "chosen_start_z",
                                     "chosen_end_x",   "chosen_end_y",   "chosen_end_z"};
    for (std::size_t k = 0; k < 6; ++k)
      notes.push_back({names[k], "m", (k < 3 ? *chosen_.start : *chosen_.end)[k % 3]});
  }
  hemodynamics::VesselLines& lines = network_.solution.display.lines;
  lines.moment(step, time_s, std::move(notes));
  return lines;
}

nlohmann::ordered_json NetworkCoupling::network_record() const {
  return studies::network_record(&network_);
}

nlohmann::ordered_json NetworkCoupling::results() const {
  nlohmann::ordered_json json{{"vessel", studies::to_json(chosen_)}};
  json.update(coupled_->results(network_s_));
  return json;
}

void NetworkCoupling::print_header(runtime::Console& console, double time_step) const {
  const coupling::WallSegment& segment = coupled_->segment();
  const std::array<double, 3>& load = coupled_->state().load.pressure;
  console.item("coupling",
               fmt::format("vessel {} ({}{}), length {}, net pressure {} to {}", chosen_.name,
                           network::name_of(chosen_.kind),
                           chosen_.generation < 0 ? "" : fmt::format(", generation {}", chosen_.generation),
                           quantity(chosen_.length, "m"), mmhg(load[0]), mmhg(load[2])));
  if (chosen_.sections) {
    const auto& [narrowest, widest] = *chosen_.sections;
    console.item("radius", fmt::format("{}, the {} of {} to {} along the vessel (coupling.radius_of)",
                                       quantity(chosen_.radius, "m"), name_of(scene_.coupling.radius_of),
                                       quantity(narrowest.radius, "m"), quantity(widest.radius, "m")));
  }
  if (!segment.whole) {
    console.item(
        "piece",
        fmt::format("the constant-N rule leaves {:.1f} spacings across the wall ({}); simulated is the "
                    "middle {} at 5 (coupling.resolution)",
                    chosen_.wall_thickness / segment.paper_spacing, quantity(segment.paper_spacing, "m"),
                    quantity(segment.length, "m")));
  }
  if (coupled_->two_way()) {
    const long steps = coupled_->steps_per_window();
    console.item("exchange", fmt::format("every {} ({} steps)",
                                         quantity(static_cast<double>(steps) * time_step, "s"), steps));
  }
}

void NetworkCoupling::print_summary(runtime::Console& console) const {
  if (coupled_->two_way()) {
    const coupling::ExchangeState& s = coupled_->state();
    console.item("bleeding",
                 fmt::format("{} at the end, {:.3g} uL in all, Reynolds number in the vessel up to {:.0f}; "
                             "net pressure in the middle then {}, in the intact vessel {}",
                             quantity(s.leak * litres_per_minute, "L/min", 3), s.leaked * 1e9,
                             s.highest_reynolds, mmhg(s.schedule * s.load.pressure[1]),
                             mmhg(s.schedule * coupled_->intact_load().pressure[1])));
    console.item("conserved", fmt::format("blood to {:.1e} of the inflow at worst, {} exchanges",
                                          s.worst_imbalance, s.windows));
  }
  console.item("network", fmt::format("solved in {}; coupling took {} s", duration(network_s_),
                                      text(coupled_->exchange_seconds())));
}

}  // namespace rhexis::scenes
