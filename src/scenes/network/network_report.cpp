// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/network/network_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/format.hpp"
#include "network/survey/survey_text.hpp"

namespace rhexis::scenes {
namespace {

std::string flow_text(double flow) {
  // Prefixes are for magnitudes; a vessel may flow against its direction.
  return fmt::format("{}{}", flow < 0 ? "-" : "", quantity(std::abs(flow) * litres_per_minute, "L/min"));
}

std::string percent(double relative) {
  return relative == 0 ? "0" : fmt::format("{:.1e}", relative);
}

void print_screening(runtime::Console& console, const studies::SolvedNetwork& network) {
  if (!network.screened) return;
  const screening::Screening& s = network.screened->screening;
  console.item("at risk", fmt::format("{} strained beyond their critical stretch{}",
                                      grouped(static_cast<long long>(s.above)),
                                      s.top.empty() ? "" : "; highest risk (strain over critical stretch):"));
  constexpr std::size_t most_said = 5;
  for (std::size_t i = 0; i < std::min(s.top.size(), most_said); ++i) {
    const hemodynamics::NetworkVessel& q = network.screened->at_risk[i];
    console.line(fmt::format(
        "  {:>10.3f}  {}{}, radius {}, wall {}{}, {} to {}{}", s.top[i].risk, q.name,
        q.generation < 0 ? "" : fmt::format(" (generation {})", q.generation), quantity(q.radius, "m", 3),
        quantity(q.wall_thickness, "m", 3), network.solution.survey && !q.wall_is_given ? " (assumed)" : "",
        mmhg(q.pressure_from), mmhg(q.pressure_to),
        s.top[i].alike > 1 ? fmt::format(", one of {} alike", grouped(static_cast<long long>(s.top[i].alike)))
                           : ""));
  }
  if (s.top.size() > most_said) console.line(fmt::format("  {:>10}  in screening.csv", "more"));
}

}  // namespace

void print_source(runtime::Console& console, const hemodynamics::FlowSolver& solver) {
  console.item("network", solver.description());
  if (solver.survey() == nullptr) return;
  for (const auto& [label, text] : network::survey_lines(*solver.survey())) console.item(label, text);
}

std::vector<std::string> warnings_of(const hemodynamics::FlowSolver& solver) {
  return solver.survey() == nullptr ? std::vector<std::string>{} : network::survey_warnings(*solver.survey());
}

void print_network(runtime::Console& console, const hemodynamics::FlowSolver& solver,
                   const hemodynamics::Parameters& h) {
  print_source(console, solver);
  console.item("blood", h.viscosity.law == hemodynamics::ViscosityLaw::constant
                            ? fmt::format("viscosity {}", quantity(h.viscosity.constant, "Pa s"))
                            : fmt::format("viscosity by diameter ({}), plasma {}, haematocrit {}{}",
                                          name_of(h.viscosity.law), quantity(h.viscosity.plasma, "Pa s"),
                                          h.viscosity.haematocrit,
                                          h.phase_separation ? ", dividing at bifurcations" : ""));
}

void print_solution(runtime::Console& console, const studies::SolvedNetwork& network) {
  const hemodynamics::NetworkSolution& solution = network.solution;
  const hemodynamics::NetworkFlow& s = solution.flow;
  if (solution.statistics) {
    console.line(
        "  generation     vessels  mean radius  flow each       arteries      veins     hoop stress");
    for (const auto& g : solution.statistics->generations) {
      // The first, the last, and every so many in between.
      const auto count = static_cast<int>(solution.statistics->generations.size());
      if (g.generation % ((count + 11) / 12) != 0 && g.generation != count - 1) continue;
      console.line(fmt::format(
          "  {:10} {:>12}  {:>11}  {:>13}  {:>7.1f} mmHg  {:>5.1f} mmHg  {:>10}", g.generation,
          grouped(2 * static_cast<long long>(g.vessels)), quantity(g.radius[0].mean, "m", 3),
          quantity(g.flow.mean * litres_per_minute, "L/min", 3), g.pressure[0].mean / pascals_per_mmhg,
          g.pressure[1].mean / pascals_per_mmhg, quantity(g.hoop_stress[0].mean, "Pa", 3)));
    }
  }
  console.item("network", fmt::format("{} vessels, {} junctions", grouped(s.vessels), grouped(s.junctions)));
  console.item("inflow",
               fmt::format("{}; Reynolds numbers up to {:.3g}", flow_text(s.inflow), s.highest_reynolds));
  console.item("pressure", fmt::format("from {} to {}", mmhg(s.highest_pressure), mmhg(s.lowest_pressure)));
  if (s.volume) {
    console.item("blood", fmt::format("{:.4g} mL in all vessels, wall surface {:.4g} m2", *s.volume * 1e6,
                                      *s.surface));
  }
  if (s.max_imbalance) {
    console.item("conserved", fmt::format("to {} of the inflow at worst", percent(*s.max_imbalance)));
  }
  console.item("solver", s.iterations ? fmt::format("{}, {} iterations", s.solver, *s.iterations) : s.solver);
  if (s.haematocrit_iterations) {
    console.item("haematocrit", fmt::format("fixed point after {} iterations", *s.haematocrit_iterations));
  }
  for (const hemodynamics::NetworkVessel& q : solution.queries) {
    console.item("vessel", fmt::format("{} ({}{}): radius {}, length {}, {} from {} to {}", q.name,
                                       network::name_of(q.kind),
                                       q.generation < 0 ? "" : fmt::format(", generation {}", q.generation),
                                       quantity(q.radius, "m"), quantity(q.length, "m"), flow_text(q.flow),
                                       mmhg(q.pressure_from), mmhg(q.pressure_to)));
  }
  print_screening(console, network);
  console.item("shown", fmt::format("{} of {} vessels", grouped(solution.display.shown), grouped(s.vessels)));
}

}  // namespace rhexis::scenes
