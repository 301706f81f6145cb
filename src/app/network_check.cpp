// SPDX-License-Identifier: BSD-3-Clause
// `rhexis check` of a network.
#include <fmt/format.h>

#include <algorithm>

#include "app/check.hpp"
#include "core/format.hpp"
#include "core/stopwatch.hpp"
#include "hemodynamics/steady/tree/tree_statistics.hpp"
#include "network/tree/tree_pair.hpp"
#include "runtime/console.hpp"
#include "scenes/network/network_report.hpp"

namespace rhexis::app {
namespace {

/// Seconds that a vessel of a streamed tree takes on these ranks, from a smaller tree of the same rules.
double seconds_per_vessel(const hemodynamics::FlowProblem& problem, parallel::Communicator comm) {
  network::TreeRules rules = problem.tree;
  rules.generations = std::min(rules.generations, 22);
  if (!rules.length_ratio_by_generation.empty()) {
    rules.length_ratio_by_generation.resize(static_cast<std::size_t>(rules.generations));
  }
  const network::TreePair tree(rules);
  const hemodynamics::Viscosity& viscosity = problem.blood.viscosity;
  const hemodynamics::TreeFlow flow(tree, viscosity, {1e4, 0, {}}, comm);
  // The first time makes tables and pages.
  double spent = 0;
  for (int pass = 0; pass < 2; ++pass) {
    spent = 0;
    const Stopwatch watch(spent);
    const hemodynamics::TreeFlow again(tree, viscosity, {1e4, 0, {}}, comm);
    if (problem.network.statistics) hemodynamics::gather_statistics(again, viscosity, comm);
  }
  return comm.all_reduce(spent, parallel::Reduce::max) / static_cast<double>(tree.vessels());
}

}  // namespace

void check(const scenes::NetworkScene& s, const scenes::Reading& reading) {
  const hemodynamics::FlowProblem& problem = s.network.problem;
  const parallel::Communicator comm = reading.comm;
  const auto solver = scenes::with_place(s, [&] { return hemodynamics::checked_solver(problem, comm); });
  runtime::Console console(comm.is_root(), false);
  console.line(s.file + " is valid.");
  for (const std::string& warning : s.warnings) console.warning(warning);
  for (const std::string& warning : scenes::warnings_of(*solver)) console.warning(warning);
  scenes::print_source(console, *solver);
  if (!problem.network.is_tree()) return;
  const network::TreePair tree(problem.tree);
  const auto vessels = static_cast<double>(tree.vessels());
  const network::TreeVessel last = tree.vessel(tree.vessels() - 2);
  console.item(
      "first",
      fmt::format("artery of radius {}, length {}, wall {}", quantity(tree.vessel(0).radius, "m"),
                  quantity(tree.vessel(0).length, "m"), quantity(tree.vessel(0).wall_thickness, "m")));
  console.item("last", fmt::format("artery of radius {}, length {}, wall {}", quantity(last.radius, "m"),
                                   quantity(last.length, "m"), quantity(last.wall_thickness, "m")));
  console.item("from heart", fmt::format("{} to the midplane", quantity(-tree.inlet()[0], "m")));
  const bool implicit = problem.network.resolved_tier() == network::Tier::implicit_tree;
  if (!implicit) {
    console.item("memory", fmt::format("about {:.3g} MB", vessels * hemodynamics::bytes_per_vessel / 1e6));
    return;
  }
  if (problem.tree.repeats()) {
    console.item("time", "none to speak of: all vessels of a generation are alike");
    return;
  }
  console.item("memory",
               fmt::format("about {:.0f} MB, all ranks together",
                           hemodynamics::TreeFlow::bytes(problem.tree.generations, comm.size()) / 1e6));
  console.item("time",
               fmt::format("about {} (measured now on a smaller tree of these rules; pictures come on top)",
                           duration(vessels * seconds_per_vessel(problem, comm))));
}

}  // namespace rhexis::app
