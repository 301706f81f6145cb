// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/coupled_vessel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "core/error.hpp"
#include "core/format.hpp"
#include "core/stopwatch.hpp"
#include "hemodynamics/poiseuille.hpp"
#include "hemodynamics/viscosity.hpp"
#include "parallel/together.hpp"
#include "peridynamics/loads/venting.hpp"

namespace rhexis::coupling {

void set_radius(hemodynamics::NetworkVessel& vessel, RadiusOf which) {
  if (!vessel.sections || which == RadiusOf::mean) return;
  const hemodynamics::VesselSection& section = (*vessel.sections)[which == RadiusOf::narrowest ? 0 : 1];
  vessel.radius = section.radius;
  vessel.wall_thickness = section.wall_thickness;
}

CoupledVessel::CoupledVessel(const Parameters& p, const hemodynamics::FlowProblem& problem,
                             double discharge_coefficient, const hemodynamics::FlowSolver& solver,
                             const hemodynamics::NetworkDisplay& display, hemodynamics::NetworkVessel vessel,
                             parallel::Communicator comm, std::vector<std::string>& warnings)
    : p_(p),
      blood_(problem.blood),
      discharge_coefficient_(discharge_coefficient),
      comm_(comm),
      chosen_(std::move(vessel)),
      in_network_(solver.vessel_in_network(chosen_.vessel)),
      data_{chosen_.radius, chosen_.wall_thickness, chosen_.length} {
  const Stopwatch watch(exchange_s_);
  parallel::together<InputError>(comm_, [&] {
    parts_ = surroundings(p_, {chosen_.name, chosen_.start, chosen_.end, display.extent},
                          mechanics_of(problem).hydrostatic, warnings);
    // Flow without a leak: pressures fall linearly.
    const double from = chosen_.pressure_from - parts_[0].acceleration;
    const double to = chosen_.pressure_to - parts_[2].acceleration;
    find_load({from, std::midpoint(from, to), to});
    for (const double pressure : state_.load.pressure) {
      if (pressure < 0) {
        throw InputError(
            "vessel '" + chosen_.name + "' has a net pressure of " + mmhg(pressure) +
                " (Eq. 7): its collapse is not modelled; raise the pressures or lower what acts from "
                "outside",
            "coupling.vessel");
      }
    }
  });
  intact_load_ = state_.load;
}

void CoupledVessel::find_load(const std::array<double, 3>& heart) {
  for (std::size_t i = 0; i < 3; ++i) {
    parts_[i].heart = heart[i];
    state_.load.pressure[i] = net_pressure(parts_[i]);
  }
}

peridynamics::Parameters CoupledVessel::extract_wall(peridynamics::Parameters wall) {
  segment_ = extract_wall_segment(data_, p_.resolution == Resolution::paper, wall);
  *wall.critical_stretch *= chosen_.strength_factor;
  wall.pressure = pressure();
  return wall;
}

void CoupledVessel::set_windows(const peridynamics::Parameters& wall, double time_step,
                                std::vector<std::string>& warnings) {
  const double steps = p_.window.value_or(std::max(wall.end_time / 200, time_step)) / time_step;
  if (two_way() && steps < 1)
    throw InputError("shorter than a time step, " + quantity(time_step, "s"), "coupling.window");
  steps_per_window_ = std::max(1L, std::lround(steps));
  // Ends that the vessel does not have must not carry its wall.
  if (segment_.whole || wall.ends != peridynamics::EndCondition::clamped) return;
  const double reach = clamped_reach(std::midpoint(wall.inner_radius, wall.outer_radius),
                                     wall.outer_radius - wall.inner_radius, wall.law.poisson_ratio);
  const double free = wall.length - 2 * *wall.end_length;
  if (free >= 2 * reach) return;
  warnings.push_back(fmt::format(
      "of the simulated piece {} lie between its clamped ends, each of which holds the wall back over {}: "
      "it bears more than the vessel would. Take boundary.ends = \"axial_periodic\" or \"sliding\", or "
      "more discretisation.particles",
      quantity(free, "m", 3), quantity(reach, "m", 3)));
}

hemodynamics::Orifice CoupledVessel::orifice(double opening) const {
  return {peridynamics::orifice_flow(discharge_coefficient_, opening, 1.0, blood_.density),
          parts_[1].outside()};
}

std::function<double(double)> CoupledVessel::profile() const {
  return axial_profile(state_.load, data_, segment_);
}

void CoupledVessel::exchange(const Wall& wall) {
  const Stopwatch watch(exchange_s_);
  parallel::on_root<RunError>(comm_, [&] {
    // All pressures of the network rise with the schedule; the network is linear in them, so it is solved at
    // full pressure, with an orifice that lets as much of the flow there out as the real one does now.
    hemodynamics::Orifice hole = orifice(wall.opening);
    hole.strength = wall.schedule > 0 ? hole.strength / std::sqrt(wall.schedule) : 0;
    // One that a restart does anew counts once.
    if (state_.windows == 0 || wall.time_s > state_.last_time) ++state_.windows;
    count_leak(wall.time_s);
    const hemodynamics::VesselState now = hemodynamics::bleed(*in_network_, wall.resistance_factor, hole);
    state_.leak = wall.schedule * now.leak;
    const hemodynamics::Viscosity& v = blood_.viscosity;
    const double fastest = wall.schedule * std::max(std::abs(now.flow_from), std::abs(now.flow_to));
    state_.highest_reynolds =
        std::max(state_.highest_reynolds,
                 hemodynamics::reynolds_number(
                     chosen_.radius, hemodynamics::apparent_viscosity(v, chosen_.radius, v.haematocrit),
                     fastest, blood_.density));
    find_load({now.pressure_from, now.pressure_middle, now.pressure_to});
    for (double& p : state_.load.pressure) p = std::max(p, 0.0);
    state_.worst_imbalance = std::max(state_.worst_imbalance, now.imbalance());
    state_.schedule = wall.schedule;
    const std::array<double, 3>& load = state_.load.pressure;
    table_.append(fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", wall.time_s, wall.schedule,
                              wall.schedule * load[0], wall.schedule * load[1], wall.schedule * load[2],
                              wall.opening, state_.leak, wall.schedule * now.inflow,
                              wall.schedule * now.outflow, wall.resistance_factor, now.imbalance()));
  });
  state_ = comm_.broadcast(state_);
}

void CoupledVessel::count_leak(double time_s) {
  state_.leaked += state_.leak * (time_s - state_.last_time);
  state_.last_time = time_s;
}

nlohmann::ordered_json CoupledVessel::results(double network_seconds) const {
  nlohmann::ordered_json json{{"mode", name_of(p_.mode)},
                              {"simulated_length_m", segment_.length},
                              {"simulated_from_m", segment_.start},
                              {"spacing_of_constant_N_m", segment_.paper_spacing},
                              {"net_pressure_Pa", intact_load_.pressure},
                              {"network_s", network_seconds},
                              {"exchange_s", exchange_s_},
                              {"windows", nullptr},
                              {"net_pressure_at_end_Pa", nullptr},
                              {"leak_m3_s", nullptr},
                              {"leaked_m3", nullptr},
                              {"highest_reynolds", nullptr},
                              {"max_imbalance", nullptr}};
  if (!two_way()) return json;
  json["windows"] = state_.windows;
  auto& at_end = json["net_pressure_at_end_Pa"] = nlohmann::ordered_json::array();
  for (const double p : state_.load.pressure) at_end.push_back(state_.schedule * p);
  json["leak_m3_s"] = state_.leak;
  json["leaked_m3"] = state_.leaked;
  json["highest_reynolds"] = state_.highest_reynolds;
  json["max_imbalance"] = state_.worst_imbalance;
  return json;
}

}  // namespace rhexis::coupling
