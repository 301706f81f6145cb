// Tier 2: the network as a graph in memory. The first rank solves; the others wait.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "app/graph_network.hpp"
#include "app/network_tier.hpp"
#include "core/error.hpp"
#include "core/format.hpp"
#include "core/memory.hpp"
#include "core/stopwatch.hpp"
#include "hemodynamics/steady/graph/graph_flow.hpp"
#include "hemodynamics/steady/graph/haematocrit.hpp"
#include "hemodynamics/steady/ruptured_network.hpp"
#include "network/tree_pair.hpp"
#include "parallel/together.hpp"
#include "runtime/console.hpp"

namespace rhexis::app {
namespace {

using network::Graph;

/// Above this many vessels a table of them is no help.
constexpr std::size_t longest_table = 100000;

class ExplicitTier : public NetworkTier {
 public:
  ExplicitTier(const Configuration& c, parallel::Communicator comm)
      : c_(c), comm_(comm), mechanics_(mechanics_of(c)) {}

  std::string description() const override {
    std::string text = describe_source(c_);
    if (c_.network.source == "file" && comm_.is_root()) {
      text +=
          fmt::format(": {} vessels, {} junctions", grouped(static_cast<long long>(network_.graph.vessels())),
                      grouped(static_cast<long long>(network_.graph.junctions)));
    }
    return text;
  }

  void prepare() override {
    parallel::on_root<InputError>(comm_, [&] {
      const Stopwatch watch(making_);
      within_memory("the network", c_.network.source == "file" ? "network.files" : "tree.generations", [&] {
        network_ = make_graph_network(c_, mechanics_.hydrostatic);
        // A tree is connected by its making.
        if (c_.network.source == "file")
          hemodynamics::check_flow_problem(network_.graph, network_.conditions, solver_options(c_));
      });
      for (const std::string& name : c_.network.query) {
        const bool coupled = c_.is_coupled() && name == c_.coupling.vessel;
        queried_.push_back(
            find_vessel(c_, network_.graph, name, coupled ? "coupling.vessel" : "network.query"));
      }
      if (c_.network.source == "file") mark_weak_vessels();
      for (const std::uint32_t v : c_.aftermath.settled) {
        if (v >= network_.graph.vessels())
          throw InputError("--restart: the network has fewer vessels than when the checkpoint was written");
      }
    });
  }

  NetworkSolution solve(const Say& say) override {
    NetworkSolution s;
    parallel::on_root<RunError>(comm_, [&] { solve_here(s, say); });
    return s;
  }

  std::unique_ptr<hemodynamics::VesselInNetwork> vessel(const QueriedVessel& queried) override {
    if (!comm_.is_root()) return nullptr;
    if (injured_) {
      return hemodynamics::vessel_in_graph(injured_->graph(), injured_->conductance(), injured_->conditions(),
                                           static_cast<std::uint32_t>(queried.vessel));
    }
    return hemodynamics::vessel_in_graph(network_.graph,
                                         conductances(network_.graph, mechanics_.viscosity, haematocrit_),
                                         network_.conditions, static_cast<std::uint32_t>(queried.vessel));
  }

 private:
  void mark_weak_vessels() {
    std::map<network::VesselKind, std::vector<network::WallVariation::Range>> marks;
    for (const std::string& name : c_.network.weakness.vessels) {
      const std::uint32_t v = find_vessel(c_, network_.graph, name, "weakness.vessels");
      marks[kind_of(v)].push_back({v, v + 1});
    }
    for (auto& [kind, numbers] : marks) mechanics_.variation.mark(kind, std::move(numbers));
  }
  network::VesselKind kind_of(std::size_t v) const {
    return network_.graph.kind.empty() ? network::VesselKind::unknown : network_.graph.kind[v];
  }

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
    s.highest_reynolds = highest_reynolds_number(graph, flow, mechanics_, haematocrit_);
    const auto driving = extremes_of(flow.pressure);
    add_weight(network_.graph, mechanics_.hydrostatic, flow.pressure);
    measure(flow, s);
    check_flow(s, driving);
    for (std::size_t i = 0; i < queried_.size(); ++i) {
      s.queries.push_back(describe(flow, queried_[i]));
      s.queries.back().name = c_.network.query[i];
    }
    if (c_.screening.top > 0) screen(flow, s);
    if (graph.vessels() <= longest_table) fill_table(flow, s);
    show(flow, s);
  }

  hemodynamics::GraphFlow find_injured_flow(NetworkSolution& s) {
    injured_.emplace(network_.graph, conductances(network_.graph, mechanics_.viscosity, {}),
                     network_.conditions, c_.aftermath.injuries);
    hemodynamics::RupturedNetwork::Result result = injured_->solve(solver_options(c_));
    s.leaks = std::move(result.leaks);
    return std::move(result.flow);
  }

  hemodynamics::GraphFlow find_flow(NetworkSolution& s) {
    if (!c_.aftermath.injuries.empty()) return find_injured_flow(s);
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
    const auto [volume, surface] = lumen_of(network_.graph);
    s.volume = volume;
    s.surface = surface;
    const auto [low, high] = extremes_of(flow.pressure);
    s.lowest_pressure = low;
    s.highest_pressure = high;
  }

  QueriedVessel describe(const hemodynamics::GraphFlow& flow, std::uint32_t v) const {
    QueriedVessel q = describe_vessel(network_.graph, flow, v, mechanics_);
    q.name = c_.network.source == "tree" ? network::TreePair::path_of(v) : network_.graph.name_of_vessel(v);
    return q;
  }

  void screen(const hemodynamics::GraphFlow& flow, NetworkSolution& s) const {
    const Graph& g = network_.graph;
    const screening::Criterion criterion = criterion_of(c_);
    const int generations =
        g.generation.empty() ? 0 : 1 + *std::max_element(g.generation.begin(), g.generation.end());
    screening::RiskTally tally(generations, static_cast<std::size_t>(c_.screening.top));
    std::vector<bool> settled(g.vessels());
    for (const std::uint32_t v : c_.aftermath.settled) settled[v] = true;
    for (std::size_t v = 0; v < g.vessels(); ++v) {
      if (settled[v]) continue;
      const double pressure = 0.5 * (flow.pressure[g.from[v]] + flow.pressure[g.to[v]]);
      if (std::isnan(pressure)) continue;  // no blood reaches it
      const network::WallFactors strength{wall_factors(g, v, mechanics_).strength, 1};
      const double thickness = wall_thickness(g, v, mechanics_) / g.radius[v];
      tally.add(g.generation.empty() ? -1 : g.generation[v], kind_of(v),
                {risk(criterion, pressure, thickness, strength), v, 1});
    }
    s.screening = tally.result(parallel::Communicator::self());
    for (const screening::RankedVessel& v : s.screening->top)
      s.at_risk.push_back(describe(flow, static_cast<std::uint32_t>(v.vessel)));
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
      s.warnings.push_back(no_coordinates);
      return;
    }
    const Graph& g = network_.graph;
    s.extent.emplace();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::ranges::minmax(k == 0 ? g.x : k == 1 ? g.y : g.z);
      (*s.extent)[k] = {low, high};
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
  std::optional<hemodynamics::RupturedNetwork> injured_;
  double making_ = 0;  ///< s
};

}  // namespace

std::unique_ptr<NetworkTier> make_explicit_tier(const Configuration& c, parallel::Communicator comm) {
  return std::make_unique<ExplicitTier>(c, comm);
}

}  // namespace rhexis::app
