// Tier 3: the network over the memory of all ranks.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "app/graph_network.hpp"
#include "app/network_tier.hpp"
#include "core/error.hpp"
#include "core/memory.hpp"
#include "core/stopwatch.hpp"
#include "hemodynamics/steady/graph/distributed_flow.hpp"
#include "network/tree_pair.hpp"
#include "parallel/together.hpp"
#include "runtime/console.hpp"

namespace rhexis::app {
namespace {

using network::Graph;

class DistributedTier : public NetworkTier {
 public:
  DistributedTier(const Configuration& c, parallel::Communicator comm)
      : c_(c), comm_(comm), mechanics_(mechanics_of(c)) {}

  std::string description() const override {
    return describe_source(c_) + fmt::format(", over {} rank{}", comm_.size(), comm_.size() > 1 ? "s" : "");
  }

  void prepare() override {
    const bool of_tree = c_.network.source == "tree";
    parallel::together<InputError>(comm_, [&] {
      within_memory("a rank's share of the network", of_tree ? "tree.generations" : "network.files",
                    [&] { of_tree ? take_tree_part() : take_slice_of_file(); });
    });
    mechanics_.numbers = vessel_id_;
  }

  NetworkSolution solve(const Say& say) override {
    NetworkSolution s;
    double spent = 0;
    hemodynamics::GraphFlow flow;
    {
      const Stopwatch watch(spent);
      flow = hemodynamics::solve_flow(part_, conductances(part_.local, mechanics_.viscosity, {}), conditions_,
                                      solver_options(c_), comm_);
    }
    say(fmt::format("  flow found in {}: {} unknowns after every rank's elimination", duration(spent),
                    grouped(flow.core_junctions)));
    s.vessels = total(static_cast<std::int64_t>(part_.local.vessels()));
    s.junctions = junctions_;
    s.inflow = flow.inflow;
    s.max_imbalance = flow.max_imbalance;
    s.solver = fmt::format("distributed, {}", hemodynamics::name_of(flow.solver));
    if (flow.iterations > 0) s.iterations = flow.iterations;
    s.highest_reynolds =
        comm_.all_reduce(highest_reynolds_number(part_.local, flow, mechanics_, {}), parallel::Reduce::max);
    const auto driving = extremes_of_all(flow.pressure);
    add_weight(part_.local, mechanics_.hydrostatic, flow.pressure);
    measure(flow, s);
    check_flow(s, driving);
    for (std::size_t i = 0; i < queried_.size(); ++i) {
      s.queries.push_back(query(queried_[i], flow));
      s.queries.back().name = c_.network.query[i];
    }
    show(flow, s);
    return s;
  }

  std::unique_ptr<hemodynamics::VesselInNetwork> vessel(const QueriedVessel&) override {
    throw InputError("a coupled vessel needs an implicit or explicit network", "network.tier");
  }

 private:
  void take_tree_part() {
    const network::TreePair tree(c_.tree);
    auto part = tree.materialise_part(comm_.rank(), comm_.size());
    part_ = {std::move(part.graph), std::move(part.junction_id)};
    junctions_ = static_cast<std::int64_t>(tree.junctions());
    vessel_id_ = std::move(part.vessel_id);
    for (const std::string& name : c_.network.query)
      queried_.push_back(static_cast<std::int64_t>(tree.id_of(name)));
    const std::int64_t outlet = std::int64_t{1} << c_.tree.generations;
    const auto local = [&](std::int64_t id) {
      return std::find(part_.junction_id.begin(), part_.junction_id.end(), id) - part_.junction_id.begin();
    };
    // Both trunks belong to the same part.
    if (local(0) < std::ssize(part_.junction_id)) {
      conditions_ = hemodynamics::conditions_of(driving_boundary(c_, tree, mechanics_.hydrostatic),
                                                static_cast<std::uint32_t>(local(0)),
                                                static_cast<std::uint32_t>(local(outlet)));
    }
  }

  /// Every rank reads the files, and keeps an even share of the vessels.
  void take_slice_of_file() {
    const network::BoundedGraph whole = make_graph_network(c_, mechanics_.hydrostatic);
    hemodynamics::check_flow_problem(whole.graph, whole.conditions, solver_options(c_));
    for (const std::string& name : c_.network.query)
      queried_.push_back(find_vessel(c_, whole.graph, name, "network.query"));
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
      own.vessel_name.push_back(g.name_of_vessel(v));
      if (!g.wall_thickness.empty()) own.wall_thickness.push_back(g.wall_thickness[v]);
      if (!g.kind.empty()) own.kind.push_back(g.kind[v]);
      if (!g.generation.empty()) own.generation.push_back(g.generation[v]);
      vessel_id_.push_back(static_cast<std::int64_t>(v));
    }
    for (network::Condition condition : whole.conditions) {
      if (local[condition.junction] == none) continue;
      condition.junction = local[condition.junction];
      conditions_.push_back(condition);
    }
  }

  std::int64_t total(std::int64_t own) const { return comm_.all_reduce(own, parallel::Reduce::sum); }

  void measure(const hemodynamics::GraphFlow& flow, NetworkSolution& s) const {
    auto sums = lumen_of(part_.local);
    comm_.all_reduce(sums, parallel::Reduce::sum);
    s.volume = sums[0];
    s.surface = sums[1];
    const auto [low, high] = extremes_of_all(flow.pressure);
    s.lowest_pressure = low;
    s.highest_pressure = high;
  }

  /// Over all ranks.
  std::array<double, 2> extremes_of_all(const std::vector<double>& pressure) const {
    const auto [low, high] = extremes_of(pressure);
    return {comm_.all_reduce(low, parallel::Reduce::min), comm_.all_reduce(high, parallel::Reduce::max)};
  }

  /// By the rank that has the vessel, told to all.
  QueriedVessel query(std::int64_t id, const hemodynamics::GraphFlow& flow) const {
    const auto found = std::find(vessel_id_.begin(), vessel_id_.end(), id);
    QueriedVessel q;
    if (found != vessel_id_.end()) {
      q = describe_vessel(part_.local, flow, static_cast<std::uint32_t>(found - vessel_id_.begin()),
                          mechanics_);
    }
    double kind = static_cast<double>(q.kind), generation = q.generation, placed = q.start && q.end ? 1 : 0;
    auto start = q.start.value_or(std::array{0.0, 0.0, 0.0}), end = q.end.value_or(start);
    double* const values[] = {
        &kind,     &generation,      &q.radius,      &q.length, &q.wall_thickness, &q.strength_factor,
        &q.flow,   &q.pressure_from, &q.pressure_to, &placed,   &start[0],         &start[1],
        &start[2], &end[0],          &end[1],        &end[2]};
    std::vector<double> sums;
    for (const double* value : values) sums.push_back(found != vessel_id_.end() ? *value : 0.0);
    comm_.all_reduce(sums, parallel::Reduce::sum);
    for (std::size_t i = 0; i < sums.size(); ++i) *values[i] = sums[i];
    q.vessel = id;
    q.kind = static_cast<network::VesselKind>(kind);
    q.generation = static_cast<int>(generation);
    q.start = placed > 0 ? std::optional(start) : std::nullopt;
    q.end = placed > 0 ? std::optional(end) : std::nullopt;
    return q;
  }

  /// Each rank shows an even share of the budget, its widest.
  void show(const hemodynamics::GraphFlow& flow, NetworkSolution& s) const {
    const bool bare = part_.local.x.empty() && part_.local.vessels() > 0;
    if (total(bare ? 1 : 0) > 0) {  // a rank that has no vessels cannot tell
      s.warnings.push_back(no_coordinates);
      return;
    }
    const std::size_t most =
        std::max<std::size_t>(1, most_shown(c_) / static_cast<std::size_t>(comm_.size()));
    const auto shown = widest_vessels(part_.local, most);
    s.lines = hemodynamics::VesselLines::of_graph(part_.local, flow, shown, {}, mechanics_);
    s.shown = total(static_cast<std::int64_t>(shown.size()));
  }

  const Configuration& c_;
  parallel::Communicator comm_;
  hemodynamics::VesselMechanics mechanics_;
  hemodynamics::DistributedGraph part_;
  std::int64_t junctions_ = 0;           ///< of the whole
  std::vector<std::int64_t> vessel_id_;  ///< [V] number in the whole
  std::vector<network::Condition> conditions_;
  std::vector<std::int64_t> queried_;  ///< numbers in the whole
};

}  // namespace

std::unique_ptr<NetworkTier> make_distributed_tier(const Configuration& c, parallel::Communicator comm) {
  return std::make_unique<DistributedTier>(c, comm);
}

}  // namespace rhexis::app
