#include "app/network_coupling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "app/flow_scene.hpp"
#include "core/error.hpp"
#include "core/format.hpp"
#include "core/stopwatch.hpp"
#include "hemodynamics/poiseuille.hpp"
#include "hemodynamics/steady/bleeding.hpp"
#include "hemodynamics/viscosity.hpp"
#include "parallel/together.hpp"
#include "peridynamics/monitors/opening.hpp"

namespace rhexis::app {

NetworkCoupling::NetworkCoupling(const Configuration& c, parallel::Communicator comm,
                                 runtime::Console& console)
    : c_(c), comm_(comm) {
  {
    const Stopwatch watch(network_s_);
    solver_ = prepared_solver(c_, comm_);
    find_named_vessel();
    console.item("network", solver_->description());
    network_ = studies::solve_network(
        *solver_, flow_problem(c_), screening_plan(c_), [&](const std::string& text) { console.line(text); },
        comm_);
    const std::vector<std::string>& warnings = network_.solution.warnings;
    c_.warnings.insert(c_.warnings.end(), warnings.begin(), warnings.end());
  }
  const Stopwatch watch(exchange_s_);
  choose();
}

const Configuration& NetworkCoupling::hand_over() {
  const Stopwatch watch(exchange_s_);
  vessel_ = solver_->vessel_in_network(chosen_.vessel);
  try {
    parallel::together<InputError>(comm_, [&] {
      if (!comm_.is_root()) return;
      data_ = {chosen_.radius, chosen_.wall_thickness, chosen_.length};
      choose_places();
      // Flow without a leak: pressures fall linearly.
      const double from = chosen_.pressure_from - parts_[0].acceleration;
      const double to = chosen_.pressure_to - parts_[2].acceleration;
      find_load({from, std::midpoint(from, to), to});
      for (const double p : load_.pressure) {
        if (p < 0) {
          throw InputError(
              "vessel '" + chosen_.name + "' has a net pressure of " + mmhg(p) +
                  " (Eq. 7): its collapse is not modelled; raise the pressures or lower what acts from "
                  "outside",
              "coupling.vessel");
        }
      }
    });
  } catch (const InputError& error) {
    throw input::located(error, c_.resolved);
  }
  // What the first rank knows of the vessel, all ranks need.
  double values[] = {data_.radius,      data_.wall_thickness, data_.length,           load_.pressure[0],
                     load_.pressure[1], load_.pressure[2],    chosen_.strength_factor};
  if (!comm_.is_root()) std::fill(std::begin(values), std::end(values), 0.0);
  comm_.all_reduce(values, parallel::Reduce::sum);
  data_ = {values[0], values[1], values[2]};
  load_.pressure = {values[3], values[4], values[5]};
  first_load_ = load_;
  *c_.vessel.critical_stretch *= values[6];
  try {
    piece_ = coupling::extract_wall_segment(data_, c_.coupling.resolution == "paper", c_.vessel);
  } catch (const InputError& error) {
    throw input::located(error, c_.resolved);
  }
  c_.vessel.pressure = pressure();
  resolve_wall(c_, comm_);
  warn_of_a_short_piece();
  const double steps =
      c_.coupling.window.value_or(std::max(c_.vessel.end_time / 200, c_.time_step)) / c_.time_step;
  if (two_way() && steps < 1) {
    throw input::located(
        InputError("shorter than a time step, " + quantity(c_.time_step, "s"), "coupling.window"),
        c_.resolved);
  }
  steps_per_window_ = std::max(1L, std::lround(steps));
  return c_;
}

/// Ends that the vessel does not have must not carry its wall.
void NetworkCoupling::warn_of_a_short_piece() {
  const peridynamics::Parameters& v = c_.vessel;
  if (piece_.whole || peridynamics::end_condition(v) != peridynamics::EndCondition::clamped) return;
  const double reach = coupling::clamped_reach(std::midpoint(v.inner_radius, v.outer_radius),
                                               v.outer_radius - v.inner_radius, v.law.poisson_ratio);
  const double free = v.length - 2 * *v.end_length;
  if (free >= 2 * reach) return;
  c_.warnings.push_back(fmt::format(
      "of the simulated piece {} lie between its clamped ends, each of which holds the wall back over {}: "
      "it bears more than the vessel would. Take boundary.ends = \"axial_periodic\" or \"sliding\", or "
      "more discretisation.particles",
      quantity(free, "m", 3), quantity(reach, "m", 3)));
}

/// Looks for what the input names before anything is solved. Throws InputError, complete with place.
void NetworkCoupling::find_named_vessel() {
  for (const std::uint32_t v : c_.aftermath.settled) {
    if (v >= solver_->vessels())
      throw InputError("--restart: the network has fewer vessels than when the checkpoint was written");
  }
  if (c_.coupling.screens()) return;
  try {
    named_ = solver_->find(c_.coupling.vessel, "coupling.vessel");
  } catch (const InputError& error) {
    throw input::located(error, c_.resolved);
  }
}

/// The vessel whose wall is simulated. A cascade comes to rest when there is none.
void NetworkCoupling::choose() {
  if (named_) {
    chosen_ = solver_->vessel(*named_);
    chosen_.name = c_.coupling.vessel;
  } else if (!network_.screened->at_risk.empty()) {
    chosen_ = network_.screened->at_risk.front();
  } else if (c_.coupling.events == 0) {
    throw input::located(InputError("no vessel's wall is under tension", "coupling.vessel"), c_.resolved);
  }
  if (chosen_.radius > 0) {
    risk_ =
        screening::risk(screening_criterion(c_), std::midpoint(chosen_.pressure_from, chosen_.pressure_to),
                        chosen_.wall_thickness / chosen_.radius, {chosen_.strength_factor, 1});
  }
  at_rest_ = c_.coupling.events > 0 && c_.coupling.screens() && !(risk_ > c_.coupling.risk_limit);
}

hemodynamics::Orifice NetworkCoupling::orifice(double opening) const {
  return {peridynamics::orifice_flow(c_.vessel.discharge_coefficient, opening, 1.0, c_.vessel.blood_density),
          middle_outside()};
}

/// The parts of the net pressure that do not come from the heart.
void NetworkCoupling::choose_places() {
  const coupling::Compression compression = coupling::compression(c_.coupling);
  const bool ranged = std::isfinite(compression.from) || std::isfinite(compression.to);
  const hemodynamics::Hydrostatic weight = mechanics_of(flow_problem(c_)).hydrostatic;
  if (ranged && !chosen_.start)
    throw InputError("needs coordinates of the network, and it has none", "body.compression_from");
  if (ranged && network_.solution.display.extent) {
    const auto [low, high] = (*network_.solution.display.extent)[static_cast<std::size_t>(compression.axis)];
    if (compression.to < low || compression.from > high) {
      throw InputError(fmt::format("the compression lies outside the body, which reaches from {} m to {} m",
                                   text(low), text(high)),
                       compression.to < low ? "body.compression_to" : "body.compression_from");
    }
  }
  if (ranged) {
    const auto axis = static_cast<std::size_t>(compression.axis);
    const std::pair<double, double> ends = std::minmax((*chosen_.start)[axis], (*chosen_.end)[axis]);
    const auto within = [&](double edge) { return edge > ends.first && edge < ends.second; };
    if (within(compression.from) || within(compression.to)) {
      c_.warnings.push_back(
          "an edge of the compression lies within the vessel, whose load is taken at its two ends "
          "and its middle, and straight between them");
    }
    if (ends.second < compression.from || ends.first > compression.to)
      c_.warnings.push_back(fmt::format("the compression does not reach vessel {}", chosen_.name));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    coupling::PressureParts& p = parts_[i];
    p.tension = c_.coupling.tension;
    p.atmosphere = c_.coupling.atmosphere;
    p.compression = compression.pressure;
    if (!chosen_.start) continue;
    std::array<double, 3> x{};
    for (std::size_t k = 0; k < 3; ++k)
      x[k] = std::lerp((*chosen_.start)[k], (*chosen_.end)[k], 0.5 * static_cast<double>(i));
    p.acceleration = weight.pressure(x[0], x[1], x[2]);
    p.compression = compression.at(x);
  }
}

void NetworkCoupling::find_load(const std::array<double, 3>& heart) {
  for (std::size_t i = 0; i < 3; ++i) {
    parts_[i].heart = heart[i];
    load_.pressure[i] = coupling::net_pressure(parts_[i]);
  }
}

std::vector<double> NetworkCoupling::profile(std::int64_t rows, double row_spacing) const {
  return coupling::axial_profile(load_, data_, piece_, rows, row_spacing);
}

void NetworkCoupling::write(const output::ResultsFolder& folder) {
  studies::write_network(network_files_plan(c_), network_, folder, comm_);
}

void NetworkCoupling::open(const output::ResultsFolder& folder) {
  write(folder);
  if (!two_way()) return;
  const std::filesystem::path path = folder.claim(table_name);
  parallel::on_root<RunError>(comm_, [&] {
    table_ = output::TableFile(path, kept_table_.empty() ? fmt::format("{}\n", table_header) : kept_table_);
  });
}

void NetworkCoupling::exchange(const Wall& wall) {
  const Stopwatch watch(exchange_s_);
  parallel::on_root<RunError>(comm_, [&] {
    // All pressures of the network rise with the schedule; the network is linear in them, so it is solved at
    // full pressure, with an orifice that lets as much of the flow there out as the real one does now.
    hemodynamics::Orifice hole = orifice(wall.opening);
    hole.strength = wall.schedule > 0 ? hole.strength / std::sqrt(wall.schedule) : 0;
    // One that a restart does anew counts once.
    if (windows_ == 0 || wall.time_s > last_time_) ++windows_;
    end(wall.time_s);
    const hemodynamics::VesselState now = hemodynamics::bleed(*vessel_, wall.resistance_factor, hole);
    leak_ = wall.schedule * now.leak;
    const hemodynamics::Viscosity& v = c_.hemodynamics.viscosity;
    const double fastest = wall.schedule * std::max(std::abs(now.flow_from), std::abs(now.flow_to));
    highest_reynolds_ =
        std::max(highest_reynolds_,
                 hemodynamics::reynolds_number(
                     chosen_.radius, hemodynamics::apparent_viscosity(v, chosen_.radius, v.haematocrit),
                     fastest, c_.hemodynamics.density));
    find_load({now.pressure_from, now.pressure_middle, now.pressure_to});
    for (double& p : load_.pressure) p = std::max(p, 0.0);
    worst_imbalance_ = std::max(worst_imbalance_, now.imbalance());
    table_.append(fmt::format(
        "{},{},{},{},{},{},{},{},{},{},{}\n", wall.time_s, wall.schedule, wall.schedule * load_.pressure[0],
        wall.schedule * load_.pressure[1], wall.schedule * load_.pressure[2], wall.opening, leak_,
        wall.schedule * now.inflow, wall.schedule * now.outflow, wall.resistance_factor, now.imbalance()));
  });
  double values[] = {load_.pressure[0], load_.pressure[1], load_.pressure[2], leak_, highest_reynolds_};
  if (!comm_.is_root()) std::fill(std::begin(values), std::end(values), 0.0);
  comm_.all_reduce(values, parallel::Reduce::sum);
  load_.pressure = {values[0], values[1], values[2]};
  leak_ = values[3];
  highest_reynolds_ = values[4];
  schedule_ = wall.schedule;
}

void NetworkCoupling::end(double time_s) {
  leaked_ += leak_ * (time_s - last_time_);
  last_time_ = time_s;
}

LineSource& NetworkCoupling::lines() {
  std::vector<Annotation> notes{
      {"vessels", "1", static_cast<double>(network_.flow().vessels)},
      {"shown", "1", static_cast<double>(network_.solution.display.shown)},
      {"inflow", "m3/s", network_.flow().inflow},
      {"leak", "m3/s", leak_},
      {"event", "1", cascade_ != nullptr ? static_cast<double>(cascade_->events.size() + 1) : 0.0}};
  if (chosen_.start) {
    constexpr const char* names[] = {"chosen_start_x", "chosen_start_y", "chosen_start_z",
                                     "chosen_end_x",   "chosen_end_y",   "chosen_end_z"};
    for (std::size_t k = 0; k < 6; ++k)
      notes.push_back({names[k], "m", (k < 3 ? *chosen_.start : *chosen_.end)[k % 3]});
  }
  network_.solution.display.lines.annotate(std::move(notes));
  return network_.solution.display.lines;
}

nlohmann::ordered_json NetworkCoupling::network_record() const {
  return studies::network_record(&network_);
}

nlohmann::ordered_json NetworkCoupling::results() const {
  nlohmann::ordered_json json{{"vessel", studies::to_json(chosen_)},
                              {"mode", c_.coupling.mode},
                              {"simulated_length_m", piece_.length},
                              {"simulated_from_m", piece_.start},
                              {"spacing_of_constant_N_m", piece_.paper_spacing},
                              {"net_pressure_Pa", first_load_.pressure},
                              {"network_s", network_s_},
                              {"exchange_s", exchange_s_},
                              {"windows", nullptr},
                              {"net_pressure_at_end_Pa", nullptr},
                              {"leak_m3_s", nullptr},
                              {"leaked_m3", nullptr},
                              {"highest_reynolds", nullptr},
                              {"max_imbalance", nullptr}};
  if (two_way()) {
    json["windows"] = windows_;
    auto& at_end = json["net_pressure_at_end_Pa"] = nlohmann::ordered_json::array();
    for (const double p : load_.pressure) at_end.push_back(schedule_ * p);
    json["leak_m3_s"] = leak_;
    json["leaked_m3"] = leaked_;
    json["highest_reynolds"] = highest_reynolds_;
    json["max_imbalance"] = worst_imbalance_;
  }
  return json;
}

void NetworkCoupling::print_header(runtime::Console& console) const {
  console.item("coupling",
               fmt::format("vessel {} ({}{}), length {}, net pressure {} to {}", chosen_.name,
                           network::name_of(chosen_.kind),
                           chosen_.generation < 0 ? "" : fmt::format(", generation {}", chosen_.generation),
                           quantity(data_.length, "m"), mmhg(load_.pressure[0]), mmhg(load_.pressure[2])));
  if (!piece_.whole) {
    console.item(
        "piece",
        fmt::format("the constant-N rule leaves {:.1f} spacings across the wall ({}); simulated is the "
                    "middle {} at 5 (coupling.resolution)",
                    data_.wall_thickness / piece_.paper_spacing, quantity(piece_.paper_spacing, "m"),
                    quantity(piece_.length, "m")));
  }
  if (two_way()) {
    console.item("exchange", fmt::format("every {} ({} steps)",
                                         quantity(static_cast<double>(steps_per_window_) * c_.time_step, "s"),
                                         steps_per_window_));
  }
}

void NetworkCoupling::print_summary(runtime::Console& console) const {
  if (two_way()) {
    console.item("bleeding",
                 fmt::format("{} at the end, {:.3g} uL in all, Reynolds number in the vessel up to {:.0f}; "
                             "net pressure in the middle then {}, in the intact vessel {}",
                             quantity(leak_ * 6e4, "L/min", 3), leaked_ * 1e9, highest_reynolds_,
                             mmhg(schedule_ * load_.pressure[1]), mmhg(schedule_ * first_load_.pressure[1])));
    console.item("conserved", fmt::format("blood to {:.1e} of the inflow at worst, {} exchanges",
                                          worst_imbalance_, windows_));
  }
  console.item("network",
               fmt::format("solved in {}; coupling took {} s", duration(network_s_), text(exchange_s_)));
}

}  // namespace rhexis::app
