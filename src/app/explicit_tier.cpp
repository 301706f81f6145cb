// Tier 2: the network as a graph in memory. The first rank solves; the others wait.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "app/console.hpp"
#include "app/graph_network.hpp"
#include "app/network_tier.hpp"
#include "app/stopwatch.hpp"
#include "core/error.hpp"
#include "core/format.hpp"
#include "hemodynamics/graph_flow.hpp"
#include "hemodynamics/haematocrit.hpp"
#include "output/together.hpp"

namespace rhexis::app {
namespace {

using network::Graph;

/// Above this many vessels a table of them is no help.
constexpr std::size_t longest_table = 100000;

class ExplicitTier : public NetworkTier {
 public:
  ExplicitTier(const Configuration& c, parallel::Communicator comm)
      : c_(c), comm_(comm), mechanics_(mechanics_of(c)) {}

  std::string description() const override { return describe_source(c_); }

  void prepare() override {
    output::on_root<InputError>(comm_, [&] {
      const Stopwatch watch(making_);
      network_ = make_graph_network(c_, mechanics_.hydrostatic);
      hemodynamics::check_flow_problem(network_.graph, network_.conditions);
      for (const std::string& name : c_.network.query)
        queried_.push_back(find_vessel(c_, network_.graph, name));
    });
  }

  NetworkSolution solve(const Say& say) override {
    NetworkSolution s;
    output::on_root<RunError>(comm_, [&] { solve_here(s, say); });
    return s;
  }

 private:
  void solve_here(NetworkSolution& s, const Say& say) {
    const Graph& graph = network_.graph;
    say(fmt::format("  network made in {}: {} vessels, {} junctions", duration(making_),
                    grouped(static_cast<long long>(graph.vessels())),
                    grouped(static_cast<long long>(graph.junctions))));
    double spent = 0;
    hemodynamics::GraphFlow flow;
    {
      const Stopwatch watch(spent);
      flow = find_flow(s);
    }
    say(fmt::format("  flow found in {}: {} unknowns after elimination", duration(spent),
                    grouped(flow.core_junctions)));
    s.vessels = static_cast<std::int64_t>(graph.vessels());
    s.junctions = static_cast<std::int64_t>(graph.junctions);
    s.inflow = flow.inflow;
    s.max_imbalance = flow.max_imbalance;
    s.solver = hemodynamics::name_of(flow.solver);
    if (flow.iterations > 0) s.iterations = flow.iterations;
    add_weight(network_, mechanics_.hydrostatic, flow.pressure);
    measure(flow, s);
    for (std::size_t i = 0; i < queried_.size(); ++i) s.queries.push_back(query(i, flow));
    if (graph.vessels() <= longest_table) fill_table(flow, s);
    show(flow, s);
  }

  hemodynamics::GraphFlow find_flow(NetworkSolution& s) {
    const auto flow_of = [&](std::span<const double> haematocrit) {
      return hemodynamics::solve_flow(network_.graph,
                                      conductances(network_.graph, mechanics_.viscosity, haematocrit),
                                      network_.conditions, solver_options(c_));
    };
    const hemodynamics::Parameters& h = c_.hemodynamics;
    if (!h.phase_separation) return flow_of({});
    hemodynamics::HaematocritFlow found = hemodynamics::find_haematocrit(
        network_.graph, flow_of, {h.viscosity.haematocrit, h.phase_tolerance, h.phase_iterations});
    if (!found.converged) {
      s.warnings.push_back(
          fmt::format("haematocrits have not converged in {} iterations: they still change by {:.1e} "
                      "(blood.phase_tolerance {:.1e})",
                      found.iterations, found.change, h.phase_tolerance));
    }
    s.haematocrit_iterations = found.iterations;
    haematocrit_ = std::move(found.haematocrit);
    return std::move(found.flow);
  }

  void measure(const hemodynamics::GraphFlow& flow, NetworkSolution& s) const {
    const Graph& g = network_.graph;
    double volume = 0, surface = 0;
    for (std::size_t v = 0; v < g.vessels(); ++v) {
      const double side = 2 * std::numbers::pi * g.radius[v] * g.length[v];
      surface += side;
      volume += side * g.radius[v] / 2;
    }
    s.volume = volume;
    s.surface = surface;
    s.highest_pressure = -INFINITY;
    s.lowest_pressure = INFINITY;
    for (const double p : flow.pressure) {
      if (std::isnan(p)) continue;
      s.highest_pressure = std::max(s.highest_pressure, p);
      s.lowest_pressure = std::min(s.lowest_pressure, p);
    }
  }

  QueriedVessel query(std::size_t i, const hemodynamics::GraphFlow& flow) const {
    const Graph& g = network_.graph;
    const std::uint32_t v = queried_[i];
    QueriedVessel q{.name = c_.network.query[i],
                    .vessel = v,
                    .kind = g.kind.empty() ? network::VesselKind::unknown : g.kind[v],
                    .generation = g.generation.empty() ? -1 : g.generation[v],
                    .radius = g.radius[v],
                    .length = g.length[v],
                    .wall_thickness = hemodynamics::wall_thickness(g, v, mechanics_),
                    .flow = flow.flow[v],
                    .pressure_from = flow.pressure[g.from[v]],
                    .pressure_to = flow.pressure[g.to[v]],
                    .start = {},
                    .end = {}};
    if (!g.x.empty()) {
      q.start = {g.x[g.from[v]], g.y[g.from[v]], g.z[g.from[v]]};
      q.end = {g.x[g.to[v]], g.y[g.to[v]], g.z[g.to[v]]};
    }
    return q;
  }

  void fill_table(const hemodynamics::GraphFlow& flow, NetworkSolution& s) const {
    const Graph& g = network_.graph;
    for (std::size_t v = 0; v < g.vessels(); ++v) {
      s.table.push_back({g.name_of_vessel(v), g.name_of_junction(g.from[v]), g.name_of_junction(g.to[v]),
                         g.radius[v], g.length[v],
                         haematocrit_.empty() ? mechanics_.viscosity.haematocrit : haematocrit_[v],
                         flow.flow[v], flow.pressure[g.from[v]], flow.pressure[g.to[v]]});
    }
  }

  void show(const hemodynamics::GraphFlow& flow, NetworkSolution& s) const {
    if (network_.graph.x.empty()) {
      s.warnings.push_back("the junctions have no coordinates: no lines to store and draw");
      return;
    }
    const auto shown = widest_vessels(network_.graph, most_shown(c_));
    s.lines = hemodynamics::VesselLines::of_graph(network_.graph, flow, shown, haematocrit_, mechanics_);
    s.shown = static_cast<std::int64_t>(shown.size());
  }

  const Configuration& c_;
  parallel::Communicator comm_;
  hemodynamics::VesselMechanics mechanics_;
  network::BoundedGraph network_;
  std::vector<double> haematocrit_;  ///< [V], with phase separation
  std::vector<std::uint32_t> queried_;
  double making_ = 0;  ///< s
};

}  // namespace

std::unique_ptr<NetworkTier> make_explicit_tier(const Configuration& c, parallel::Communicator comm) {
  return std::make_unique<ExplicitTier>(c, comm);
}

}  // namespace rhexis::app
