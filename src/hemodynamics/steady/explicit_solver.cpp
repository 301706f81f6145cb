// SPDX-License-Identifier: BSD-3-Clause
// The network as a graph in the memory of the first rank, which solves; the others wait.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.hpp"
#include "core/format.hpp"
#include "core/memory.hpp"
#include "core/stopwatch.hpp"
#include "hemodynamics/steady/flow_solver.hpp"
#include "hemodynamics/steady/graph/graph_flow.hpp"
#include "hemodynamics/steady/graph/haematocrit.hpp"
#include "hemodynamics/steady/graph/network_graph.hpp"
#include "hemodynamics/steady/ruptured_network.hpp"
#include "network/connectivity.hpp"
#include "network/tree/tree_pair.hpp"
#include "parallel/together.hpp"

namespace rhexis::hemodynamics {
namespace {

using network::Graph;

/// Above this many vessels a table of them is no help.
constexpr std::size_t longest_table = 100000;

class ExplicitSolver final : public FlowSolver {
 public:
  ExplicitSolver(FlowProblem problem, parallel::Communicator comm)
      : problem_(std::move(problem)), comm_(comm), mechanics_(mechanics_of(problem_)) {}

  std::string description() const override {
    std::string text = describe_source(problem_);
    if (!problem_.is_tree() && comm_.is_root()) {
      text +=
          fmt::format(": {} vessels, {} junctions", grouped(static_cast<long long>(network_.graph.vessels())),
                      grouped(static_cast<long long>(network_.graph.junctions)));
    }
    return text;
  }

  void prepare() override {
    parallel::on_root<InputError>(comm_, [&] {
      const Stopwatch watch(making_);
      within_memory("the network", !problem_.is_tree() ? "network.files" : "tree.generations", [&] {
        network_ = make_graph_network(problem_, mechanics_.hydrostatic);
        // A tree is connected by its making.
        if (problem_.is_tree()) return;
        const std::vector<std::uint32_t> part = network::first_of_part(network_.graph);
        check_flow_problem(network_.graph, network_.conditions, part, problem_.blood.graph_solver);
        survey_ = network::survey_of(network_, part);
      });
      for (const std::string& name : problem_.network.query)
        queried_.push_back(find_vessel(problem_, network_.graph, name, "network.query"));
      if (!problem_.is_tree()) mark_weak_vessels();
    });
  }

  std::int64_t vessels() const override {
    return comm_.broadcast(static_cast<std::int64_t>(network_.graph.vessels()));
  }

  const network::NetworkSurvey* survey() const override { return survey_ ? &*survey_ : nullptr; }

  std::int64_t find(const std::string& name, const std::string& key) const override {
    std::int64_t number = 0;
    parallel::on_root<InputError>(comm_, [&] { number = find_vessel(problem_, network_.graph, name, key); });
    return comm_.broadcast(number);
  }

  NetworkSolution solve(const Progress& progress, VesselVisitor* visitor) override {
    NetworkSolution s;
    parallel::on_root<RunError>(comm_, [&] { solve_here(s, progress, visitor); });
    return s;
  }

  NetworkVessel vessel(std::int64_t number) const override {
    return broadcast(comm_, comm_.is_root() ? describe(static_cast<std::uint32_t>(number)) : NetworkVessel{});
  }

  std::unique_ptr<VesselInNetwork> vessel_in_network(std::int64_t number) const override {
    if (!comm_.is_root()) return nullptr;
    const auto vessel = static_cast<std::uint32_t>(number);
    if (ruptured_) {
      return vessel_in_graph(ruptured_->graph(), ruptured_->conductance(), ruptured_->conditions(), vessel);
    }
    return vessel_in_graph(network_.graph, conductances(network_.graph, mechanics_.viscosity, haematocrit_),
                           network_.conditions, vessel);
  }

 private:
  void mark_weak_vessels() {
    std::map<network::VesselKind, std::vector<network::WallVariation::Range>> marks;
    for (const std::string& name : problem_.network.weakness.vessels) {
      const std::uint32_t v = find_vessel(problem_, network_.graph, name, "weakness.vessels");
      marks[kind_of(v)].push_back({v, v + 1});
    }
    for (auto& [kind, numbers] : marks) mechanics_.variation.mark(kind, std::move(numbers));
  }
  network::VesselKind kind_of(std::size_t v) const {
    return network_.graph.kind.empty() ? network::VesselKind::unknown : network_.graph.kind[v];
  }

  void solve_here(NetworkSolution& s, const Progress& progress, VesselVisitor* visitor) {
    const Graph& graph = network_.graph;
    progress(fmt::format("  network made in {}: {} vessels, {} junctions", duration(making_),
                         grouped(static_cast<long long>(graph.vessels())),
                         grouped(static_cast<long long>(graph.junctions))));
    double spent = 0;
    {
      const Stopwatch watch(spent);
      flow_ = find_flow(s);
    }
    progress(fmt::format("  flow found in {}: {} unknowns after elimination", duration(spent),
                         grouped(flow_.core_junctions)));
    const auto driving = extremes_of(flow_.pressure);
    add_weight(graph, mechanics_.hydrostatic, flow_.pressure);
    measure(s.flow);
    check_flow(s, driving);
    for (std::size_t i = 0; i < queried_.size(); ++i) {
      s.queries.push_back(describe(queried_[i]));
      s.queries.back().name = problem_.network.query[i];
    }
    if (visitor != nullptr) visitor->visit(graph, flow_, mechanics_);
    if (graph.vessels() <= longest_table) s.table = table();
    s.survey = survey_;
    show(s);
  }

  GraphFlow find_flow(NetworkSolution& s) {
    const GraphSolverOptions options = problem_.blood.graph_solver;
    if (!problem_.failures.empty()) {
      ruptured_.emplace(network_.graph, conductances(network_.graph, mechanics_.viscosity, {}),
                        network_.conditions, problem_.failures);
      RupturedNetwork::Result result = ruptured_->solve(options);
      s.flow.leaks = std::move(result.leaks);
      return std::move(result.flow);
    }
    const auto flow_of = [&](std::span<const double> haematocrit) {
      return solve_flow(network_.graph, conductances(network_.graph, mechanics_.viscosity, haematocrit),
                        network_.conditions, options);
    };
    const Parameters& blood = problem_.blood;
    if (!blood.phase_separation) return flow_of({});
    HaematocritFlow found =
        find_haematocrit(network_.graph, flow_of,
                         {.inflow_haematocrit = blood.viscosity.haematocrit,
                          .entering = entering_haematocrit(network_, blood.viscosity.haematocrit),
                          .tolerance = blood.phase_tolerance,
                          .max_iterations = blood.phase_iterations});
    if (!found.converged) {
      s.warnings.push_back(
          fmt::format("haematocrits have not converged in {} iterations: they still change by {:.1e} "
                      "(blood.phase_tolerance {:.1e}), by {:.1e} in the mean weighted by flow",
                      found.iterations, found.change, blood.phase_tolerance, found.mean_change));
    }
    if (found.converged) s.flow.haematocrit_iterations = found.iterations;
    haematocrit_ = std::move(found.haematocrit);
    return std::move(found.flow);
  }

  void measure(NetworkFlow& f) const {
    f.vessels = static_cast<std::int64_t>(network_.graph.vessels());
    f.junctions = static_cast<std::int64_t>(network_.graph.junctions);
    f.inflow = flow_.inflow;
    f.max_imbalance = flow_.max_imbalance;
    f.solver = name_of(flow_.solver);
    if (flow_.iterations > 0) f.iterations = flow_.iterations;
    f.highest_reynolds = highest_reynolds_number(network_.graph, flow_, mechanics_, haematocrit_);
    const auto [volume, surface] = lumen_of(network_.graph);
    f.volume = volume;
    f.surface = surface;
    const auto [low, high] = extremes_of(flow_.pressure);
    f.lowest_pressure = low;
    f.highest_pressure = high;
  }

  NetworkVessel describe(std::uint32_t v) const {
    NetworkVessel q = describe_vessel(network_.graph, flow_, v, mechanics_);
    q.name = problem_.is_tree() ? network::TreePair::path_of(v) : network_.graph.name_of_vessel(v);
    return q;
  }

  std::vector<VesselTableRow> table() const {
    const Graph& g = network_.graph;
    std::vector<VesselTableRow> rows;
    for (std::size_t v = 0; v < g.vessels(); ++v) {
      rows.push_back({g.name_of_vessel(v), g.name_of_junction(g.from[v]), g.name_of_junction(g.to[v]),
                      g.radius[v], g.length[v],
                      haematocrit_.empty() ? mechanics_.viscosity.haematocrit : haematocrit_[v],
                      flow_.flow[v], flow_.pressure[g.from[v]], flow_.pressure[g.to[v]]});
    }
    return rows;
  }

  void show(NetworkSolution& s) const {
    const Graph& g = network_.graph;
    if (g.x.empty()) {
      s.warnings.emplace_back(no_coordinates);
      return;
    }
    s.display.extent.emplace();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::ranges::minmax(k == 0 ? g.x : k == 1 ? g.y : g.z);
      (*s.display.extent)[k] = {low, high};
    }
    const auto shown = widest_vessels(g, most_shown(problem_));
    s.display.lines = VesselLines::of_graph(g, flow_, shown, haematocrit_, mechanics_);
    s.display.shown = static_cast<std::int64_t>(shown.size());
  }

  FlowProblem problem_;
  parallel::Communicator comm_;
  VesselMechanics mechanics_;
  network::BoundedGraph network_;
  std::optional<network::NetworkSurvey> survey_;  ///< of a network from files
  std::vector<double> haematocrit_;               ///< [V], with phase separation
  std::vector<std::uint32_t> queried_;
  GraphFlow flow_;  ///< with the weight of blood in its pressures
  std::optional<RupturedNetwork> ruptured_;
  double making_ = 0;  ///< s
};

}  // namespace

std::unique_ptr<FlowSolver> make_explicit_solver(FlowProblem problem, parallel::Communicator comm) {
  return std::make_unique<ExplicitSolver>(std::move(problem), comm);
}

}  // namespace rhexis::hemodynamics
