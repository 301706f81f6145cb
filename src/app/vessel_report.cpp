// What a vessel's run says of itself: at its start, at its end, and in run.json.
#include <fmt/format.h>

#include "app/stopwatch.hpp"
#include "app/version.hpp"
#include "app/vessel_run.hpp"
#include "core/format.hpp"
#include "peridynamics/bond_kernel.hpp"

namespace rhexis::app {

output::Performance VesselRun::performance() const {
  output::Performance p;
  p.ranks = comm_.size();
  p.threads = parallel::thread_count();
  p.wall_s = seconds_now() - started_;
  p.solve_s = spent_.solve;
  p.insitu_s = spent_.insitu;
  p.output_s = spent_.output;
  p.bond_evaluations = comm_.all_reduce(body_->bond_evaluations(), parallel::Reduce::sum);
  if (spent_.solve > 0) p.bond_evaluations_per_s = static_cast<double>(*p.bond_evaluations) / spent_.solve;
  p.flop = static_cast<double>(*p.bond_evaluations) * peridynamics::flop_per_bond;
  p.peak_rss_bytes = comm_.all_reduce(output::peak_resident_bytes(), parallel::Reduce::sum);
  p.node_hours = *p.wall_s * comm_.node_count() / 3600;
  return p;
}

void VesselRun::say_header() {
  const peridynamics::Parameters& v = c_.vessel;
  console_.line(
      fmt::format("Rhexis {} ({}): {}", version(), commit(), c_.title.empty() ? c_.file : c_.title));
  for (const std::string& warning : c_.warnings) console_.warning(warning);
  console_.item("input", c_.file);
  console_.item("vessel", fmt::format("lumen radius {}, outer radius {}, length {}; ends {}",
                                      quantity(v.inner_radius, "m"), quantity(v.outer_radius, "m"),
                                      quantity(v.length, "m"), v.ends));
  console_.item("particles", fmt::format("{} ({} columns x {} rows, {}), spacing {}, horizon {}",
                                         grouped(*results_.particles), lattice_.section.size(), lattice_.rows,
                                         v.cross_section, quantity(lattice_.spacing, "m"),
                                         quantity(lattice_.horizon, "m")));
  console_.item("bonds", fmt::format("{}, at most {} a particle, {} precision", grouped(*results_.bonds),
                                     *results_.family_max, v.bond_precision));
  console_.item("time", fmt::format("{} steps of {} ({:.0f} % of the stable {})", c_.steps - first_step_,
                                    quantity(c_.time_step, "s"), 100 * c_.time_step / c_.stable_time_step,
                                    quantity(c_.stable_time_step, "s")));
  console_.item("load",
                fmt::format("{} ({}), layer {}, venting {}",
                            quantity(v.schedule == "table" ? v.table.back().second : v.pressure, "Pa"),
                            v.schedule, v.layer, v.venting));
  console_.item("parallel", fmt::format("{} rank{} x {} thread{}", comm_.size(), comm_.size() > 1 ? "s" : "",
                                        parallel::thread_count(), parallel::thread_count() > 1 ? "s" : ""));
  console_.item("pictures", renderer_);
  console_.item("results", options_.directory.string());
}

void VesselRun::say_summary() {
  const output::Results& r = results_;
  const output::Performance p = performance();
  const auto at = [](const std::optional<double>& time) { return time ? quantity(*time, "s") : "none"; };
  console_.line(interrupted_ ? "Interrupted; everything so far is saved." : "Done.");
  console_.item("first break", at(r.first_bond_break_s));
  console_.item("rupture", r.rupture_onset_s
                               ? fmt::format("begins at {} (damage {} somewhere), {} long at the end",
                                             at(r.rupture_onset_s), peridynamics::rupture_damage,
                                             quantity(*r.rupture_length_m, "m"))
                               : "none");
  console_.item(
      "at the end",
      fmt::format("largest displacement {}, largest damage {:.0f} %, opening {:.3g} mm2",
                  quantity(*r.max_displacement_m, "m", 3), 100 * *r.max_damage, *r.opening_area_m2 * 1e6));
  if (least_vent_ < 1) {
    console_.item("venting", fmt::format("the opening let the pressure fall to {:.0f} % of the scheduled one",
                                         100 * least_vent_));
  }
  console_.item("energy", fmt::format("balance off by {:.1e} of the work done", *r.energy_drift));
  const long steps = step_ - first_step_;
  console_.item("speed", fmt::format("{:.0f} steps/s, {:.3g} bonds/s",
                                     *p.solve_s > 0 ? static_cast<double>(steps) / *p.solve_s : 0.0,
                                     p.bond_evaluations_per_s.value_or(0)));
  console_.item("time spent",
                fmt::format("{} in all: {} solving, {} pictures, {} output", duration(*p.wall_s),
                            duration(*p.solve_s), duration(*p.insitu_s), duration(*p.output_s)));
  console_.item("memory",
                fmt::format("{:.0f} MB over all ranks", static_cast<double>(*p.peak_rss_bytes) / 1e6));
  console_.item("results", options_.directory.string());
}

}  // namespace rhexis::app
