// SPDX-License-Identifier: BSD-3-Clause
// The network as a graph over the memory of all ranks.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "core/error.hpp"
#include "core/memory.hpp"
#include "core/stopwatch.hpp"
#include "hemodynamics/steady/flow_solver.hpp"
#include "hemodynamics/steady/graph/distributed_flow.hpp"
#include "hemodynamics/steady/graph/network_graph.hpp"
#include "network/connectivity.hpp"
#include "network/tree/tree_pair.hpp"
#include "parallel/together.hpp"

namespace rhexis::hemodynamics {
namespace {

using network::Graph;

class DistributedSolver final : public FlowSolver {
 public:
  DistributedSolver(FlowProblem problem, parallel::Communicator comm)
      : problem_(std::move(problem)), comm_(comm), mechanics_(mechanics_of(problem_)) {}

  std::string description() const override {
    return describe_source(problem_) +
           fmt::format(", over {} rank{}", comm_.size(), comm_.size() > 1 ? "s" : "");
  }

  void prepare() override {
    const bool of_tree = problem_.is_tree();
    parallel::together<InputError>(comm_, [&] {
      within_memory("a rank's share of the network", of_tree ? "tree.generations" : "network.files",
                    [&] { of_tree ? take_tree_part() : take_slice_of_file(); });
    });
    mechanics_.numbers = vessel_id_;
  }

  std::int64_t vessels() const override { return total(static_cast<std::int64_t>(part_.local.vessels())); }

  const network::NetworkSurvey* survey() const override { return survey_ ? &*survey_ : nullptr; }

  std::int64_t find(const std::string&, const std::string& key) const override {
    throw InputError("vessels are found by name with network.tier = \"implicit\" or \"explicit\"", key);
  }

  NetworkSolution solve(const Progress& progress, VesselVisitor*) override {
    NetworkSolution s;
    double spent = 0;
    {
      const Stopwatch watch(spent);
      flow_ = solve_flow(part_, conductances(part_.local, mechanics_.viscosity, {}), conditions_,
                         problem_.blood.graph_solver, comm_);
    }
    progress(fmt::format("  flow found in {}: {} unknowns after every rank's elimination", duration(spent),
                         grouped(flow_.core_junctions)));
    const auto driving = extremes_of_all(flow_.pressure);
    add_weight(part_.local, mechanics_.hydrostatic, flow_.pressure);
    s.flow = measure();
    check_flow(s, driving);
    for (std::size_t i = 0; i < queried_.size(); ++i) {
      s.queries.push_back(vessel(queried_[i]));
      s.queries.back().name = problem_.network.query[i];
    }
    s.survey = survey_;
    show(s);
    return s;
  }

  /// By the rank that has the vessel, told to all.
  NetworkVessel vessel(std::int64_t number) const override {
    const auto found = std::find(vessel_id_.begin(), vessel_id_.end(), number);
    const bool here = found != vessel_id_.end();
    NetworkVessel v;
    if (here) {
      const auto local = static_cast<std::uint32_t>(found - vessel_id_.begin());
      v = describe_vessel(part_.local, flow_, local, mechanics_);
      v.vessel = number;
      v.name = problem_.is_tree() ? network::TreePair::path_of(static_cast<std::uint64_t>(number))
                                  : part_.local.name_of_vessel(local);
    }
    const std::int64_t owner =
        comm_.all_reduce(std::int64_t{here ? comm_.rank() : -1}, parallel::Reduce::max);
    return broadcast(comm_, v, static_cast<int>(owner));
  }

  std::unique_ptr<VesselInNetwork> vessel_in_network(std::int64_t) const override {
    throw InputError("a coupled vessel needs an implicit or explicit network", "network.tier");
  }

 private:
  void take_tree_part() {
    const network::TreePair tree(problem_.tree);
    auto part = tree.materialise_part(comm_.rank(), comm_.size());
    part_ = {std::move(part.graph), std::move(part.junction_id)};
    junctions_ = static_cast<std::int64_t>(tree.junctions());
    vessel_id_ = std::move(part.vessel_id);
    for (const std::string& name : problem_.network.query)
      queried_.push_back(static_cast<std::int64_t>(tree.id_of(name)));
    const std::int64_t outlet = std::int64_t{1} << problem_.tree.generations;
    const auto local = [&](std::int64_t id) {
      return std::find(part_.junction_id.begin(), part_.junction_id.end(), id) - part_.junction_id.begin();
    };
    // Both trunks belong to the same part.
    if (local(0) < std::ssize(part_.junction_id)) {
      conditions_ =
          conditions_of(driving_boundary(problem_, tree, mechanics_.hydrostatic),
                        static_cast<std::uint32_t>(local(0)), static_cast<std::uint32_t>(local(outlet)));
    }
  }

  /// Every rank reads the files, and keeps an even share of the vessels.
  void take_slice_of_file() {
    const network::BoundedGraph whole = make_graph_network(problem_, mechanics_.hydrostatic);
    const std::vector<std::uint32_t> part = network::first_of_part(whole.graph);
    check_flow_problem(whole.graph, whole.conditions, part, problem_.blood.graph_solver);
    if (comm_.is_root()) survey_ = network::survey_of(whole, part);
    for (const std::string& name : problem_.network.query)
      queried_.push_back(find_vessel(problem_, whole.graph, name, "network.query"));
    const auto share = [&](int r) {
      return whole.graph.vessels() * static_cast<std::size_t>(r) / static_cast<std::size_t>(comm_.size());
    };
    junctions_ = static_cast<std::int64_t>(whole.graph.junctions);
    slice(whole, share(comm_.rank()), share(comm_.rank() + 1));
  }

  void slice(const network::BoundedGraph& whole, std::size_t begin, std::size_t end) {
    constexpr std::uint32_t none = 0xffffffff;
    const Graph& g = whole.graph;
    Graph& own = part_.local;
    std::vector<std::uint32_t> local(g.junctions, none);
    const auto take = [&](std::uint32_t j) {
      if (local[j] == none) {
        local[j] = static_cast<std::uint32_t>(own.junctions++);
        part_.junction_id.push_back(j);
        own.junction_name.push_back(g.name_of_junction(j));
        if (!g.x.empty()) {
          own.x.push_back(g.x[j]);
          own.y.push_back(g.y[j]);
          own.z.push_back(g.z[j]);
        }
      }
      return local[j];
    };
    for (std::size_t v = begin; v < end; ++v) {
      own.from.push_back(take(g.from[v]));
      own.to.push_back(take(g.to[v]));
      own.radius.push_back(g.radius[v]);
      own.length.push_back(g.length[v]);
      if (!g.first_piece.empty()) own.add_pieces(g.pieces(v));
      own.vessel_name.push_back(g.name_of_vessel(v));
      if (!g.wall_thickness.empty()) own.wall_thickness.push_back(g.wall_thickness[v]);
      if (!g.kind.empty()) own.kind.push_back(g.kind[v]);
      if (!g.generation.empty()) own.generation.push_back(g.generation[v]);
      vessel_id_.push_back(static_cast<std::int64_t>(v));
    }
    for (network::BoundaryCondition condition : whole.conditions) {
      if (local[condition.junction] == none) continue;
      condition.junction = local[condition.junction];
      conditions_.push_back(condition);
    }
  }

  std::int64_t total(std::int64_t own) const { return comm_.all_reduce(own, parallel::Reduce::sum); }

  NetworkFlow measure() const {
    NetworkFlow f;
    f.vessels = total(static_cast<std::int64_t>(part_.local.vessels()));
    f.junctions = junctions_;
    f.inflow = flow_.inflow;
    f.max_imbalance = flow_.max_imbalance;
    f.solver = fmt::format("distributed, {}", name_of(flow_.solver));
    if (flow_.iterations > 0) f.iterations = flow_.iterations;
    f.highest_reynolds =
        comm_.all_reduce(highest_reynolds_number(part_.local, flow_, mechanics_, {}), parallel::Reduce::max);
    auto sums = lumen_of(part_.local);
    comm_.all_reduce(sums, parallel::Reduce::sum);
    f.volume = sums[0];
    f.surface = sums[1];
    const auto [low, high] = extremes_of_all(flow_.pressure);
    f.lowest_pressure = low;
    f.highest_pressure = high;
    return f;
  }

  /// The lowest and the highest of all ranks.
  std::array<double, 2> extremes_of_all(const std::vector<double>& pressure) const {
    const auto [low, high] = extremes_of(pressure);
    return {comm_.all_reduce(low, parallel::Reduce::min), comm_.all_reduce(high, parallel::Reduce::max)};
  }

  /// Each rank shows an even share of the budget, its widest.
  void show(NetworkSolution& s) const {
    const bool bare = part_.local.x.empty() && part_.local.vessels() > 0;
    if (total(bare ? 1 : 0) > 0) {  // a rank that has no vessels cannot tell
      s.warnings.emplace_back(no_coordinates);
      return;
    }
    const std::size_t most =
        std::max<std::size_t>(1, most_shown(problem_) / static_cast<std::size_t>(comm_.size()));
    const auto shown = widest_vessels(part_.local, most);
    s.display.lines = VesselLines::of_graph(part_.local, flow_, shown, {}, mechanics_);
    s.display.shown = total(static_cast<std::int64_t>(shown.size()));
  }

  FlowProblem problem_;
  parallel::Communicator comm_;
  VesselMechanics mechanics_;
  DistributedGraph part_;
  std::optional<network::NetworkSurvey> survey_;  ///< of a network from files, on the first rank
  std::int64_t junctions_ = 0;                    ///< junctions of the whole network
  std::vector<std::int64_t> vessel_id_;           ///< [V] number in the whole
  std::vector<network::BoundaryCondition> conditions_;
  GraphFlow flow_;                     ///< with the weight of blood in its pressures
  std::vector<std::int64_t> queried_;  ///< numbers in the whole
};

}  // namespace

std::unique_ptr<FlowSolver> make_distributed_solver(FlowProblem problem, parallel::Communicator comm) {
  return std::make_unique<DistributedSolver>(std::move(problem), comm);
}

}  // namespace rhexis::hemodynamics
