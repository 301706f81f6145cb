// SPDX-License-Identifier: BSD-3-Clause
// What a vessel's run says of itself: at its start, at its end, and in run.json.
#include <fmt/format.h>

#include "core/format.hpp"
#include "peridynamics/laws/strength.hpp"
#include "peridynamics/loads/schedule.hpp"
#include "scenes/vessel/vessel_run.hpp"

namespace rhexis::scenes {

void print_risk(runtime::Console& console, const peridynamics::Parameters& v) {
  const std::optional<double> risk = risk_of_load(v);
  if (!risk) return;
  console.item(
      "risk", fmt::format("{:.3g} at {}: the lumen's hoop strain, were it elastic, over the critical stretch",
                          *risk, quantity(peridynamics::highest_pressure(v), "Pa")));
}

void VesselRun::print_header() {
  const peridynamics::Parameters& v = c_.wall->parameters;
  // A coupled run has said its title before the network was solved.
  if (network_ == nullptr) session_.print_title();
  session_.warn(c_.warnings);
  if (!session_.options().restart.empty()) {
    session_.console().item("restart", fmt::format("from step {} ({}) of {}", first_step_,
                                                   quantity(simulation_->time_at(first_step_), "s"),
                                                   session_.options().restart.string()));
  }
  session_.console().item("vessel", fmt::format("lumen radius {}, outer radius {}, length {}; ends {}",
                                                quantity(v.inner_radius, "m"), quantity(v.outer_radius, "m"),
                                                quantity(v.length, "m"), name_of(v.ends)));
  session_.console().item(
      "particles",
      fmt::format("{} ({} columns x {} rows, {}), spacing {}, horizon {}", grouped(*results_.particles),
                  c_.wall->lattice().section.size(), c_.wall->lattice().rows, name_of(v.cross_section),
                  quantity(c_.wall->lattice().spacing, "m"), quantity(c_.wall->lattice().horizon, "m")));
  const peridynamics::Scatter& scatter = v.scatter;
  if (!scatter.none()) {
    session_.console().item(
        "scatter", fmt::format("critical stretch {:g} %, stiffness {:g} % ({}) over {}, seed {}",
                               100 * scatter.critical_stretch, 100 * scatter.stiffness, name_of(scatter.law),
                               quantity(*scatter.correlation_length, "m"), scatter.seed));
  }
  if (!v.spots.list.empty()) {
    session_.console().item("spots",
                            fmt::format("{}, which leave out {} particles", v.spots.list.size(),
                                        grouped(c_.wall->lattice().particles() - *results_.particles)));
  }
  session_.console().item("bonds",
                          fmt::format("{}, at most {} a particle, {} precision", grouped(*results_.bonds),
                                      *results_.family_max, name_of(v.bond_precision)));
  if (v.law.by_gradient())
    session_.console().item("law", fmt::format("{}, Poisson's ratio {:g}", v.law.name, v.law.poisson_ratio));
  session_.console().item("strength", peridynamics::describe_strength(v));
  session_.console().item(
      "time", fmt::format("{} steps of {} ({:.0f} % of the stable {})", c_.wall->time.count - first_step_,
                          quantity(c_.wall->time.step, "s"), 100 * c_.wall->time.step / c_.wall->time.stable,
                          quantity(c_.wall->time.stable, "s")));
  session_.console().item(
      "load", fmt::format("{} ({}) {}{}, venting {}", quantity(peridynamics::highest_pressure(v), "Pa"),
                          peridynamics::describe_schedule(v), peridynamics::describe_direction(v),
                          v.law.by_gradient() ? "" : fmt::format(", layer {}", name_of(v.layer)),
                          name_of(v.venting)));
  if (network_ != nullptr) {
    network_->print_header(session_.console(), c_.wall->time.step);
  } else {
    print_risk(session_.console(), v);
  }
  session_.print_surroundings();
}

std::string VesselRun::pressures_at_onset(double pressure, double blood_pressure, int digits) const {
  const bool dead = c_.wall->parameters.direction == peridynamics::LoadDirection::dead;
  return (dead ? quantity(pressure, "Pa", digits) + " on the undeformed lumen, " : "") +
         "a blood pressure of " + quantity(blood_pressure, "Pa", digits);
}

void VesselRun::print_onset(const peridynamics::RuptureEvents& rupture) {
  session_.console().line(fmt::format("  rupture begins at {} under {}, largest displacement {}",
                                      quantity(*rupture.onset, "s"),
                                      pressures_at_onset(*rupture.pressure, *rupture.blood_pressure, 4),
                                      quantity(*rupture.max_displacement, "m", 3)));
}

void VesselRun::print_summary() {
  const Results& r = results_;
  const runtime::Performance p = session_.performance();
  const auto at = [](const std::optional<double>& time) { return time ? quantity(*time, "s") : "none"; };
  session_.console().line(signal_ != 0 ? "Interrupted; everything so far is saved." : "Done.");
  session_.console().item("first break", at(r.first_bond_break_s));
  session_.console().item(
      "rupture",
      r.rupture_onset_s
          ? fmt::format("begins at {} (damage {} somewhere) under {}, {} long at the end",
                        at(r.rupture_onset_s), peridynamics::rupture_damage,
                        pressures_at_onset(*r.pressure_at_onset_Pa, *r.blood_pressure_at_onset_Pa, 3),
                        quantity(*r.rupture_length_m, "m"))
          : "none");
  session_.console().item(
      "at the end",
      fmt::format("largest displacement {}, largest damage {:.0f} %, opening {:.3g} mm2",
                  quantity(*r.max_displacement_m, "m", 3), 100 * *r.max_damage, *r.opening_area_m2 * 1e6));
  if (simulation_->load().least_share < 1) {
    session_.console().item("venting",
                            fmt::format("the opening let the pressure fall to {:.0f} % of the scheduled one",
                                        100 * simulation_->load().least_share));
  }
  session_.console().item("energy", fmt::format("balance off by {:.1e} of the work done", *r.energy_drift));
  const long steps = step() - first_step_;
  session_.console().item("speed", fmt::format("{:.0f} steps/s, {:.3g} bonds/s, both ends counted",
                                               *p.solve_s > 0 ? static_cast<double>(steps) / *p.solve_s : 0.0,
                                               p.bond_evaluations_per_s.value_or(0)));
  if (network_ != nullptr) network_->print_summary(session_.console());
  session_.print_cost(p);
}

}  // namespace rhexis::scenes
