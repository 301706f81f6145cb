// SPDX-License-Identifier: BSD-3-Clause
// The tree pair by recursion; nothing is stored.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/format.hpp"
#include "core/stopwatch.hpp"
#include "hemodynamics/poiseuille.hpp"
#include "hemodynamics/steady/flow_solver.hpp"
#include "hemodynamics/steady/tree/tree_flow.hpp"
#include "hemodynamics/viscosity.hpp"
#include "network/tree/tree_selection.hpp"

namespace rhexis::hemodynamics {
namespace {

using network::TreePair;

/// Blood through every generation against the inflow: what the sweep itself shows of conservation.
double worst_generation(const TreeStatistics& s, double inflow) {
  double worst = 0;
  for (const auto& g : s.generations)
    worst = std::max(worst, std::abs(std::abs(g.flow.mean) * g.vessels / inflow - 1));
  return inflow > 0 ? worst : 0;
}

class ImplicitSolver final : public FlowSolver {
 public:
  ImplicitSolver(FlowProblem problem, parallel::Communicator comm)
      : problem_(std::move(problem)), comm_(comm), tree_(problem_.tree), mechanics_(mechanics_of(problem_)) {}

  std::string description() const override {
    const network::TreeRules& r = problem_.tree;
    std::string text =
        fmt::format("tree pair of {} generations: {} vessels, radii from {} to {}{} (xi {})", r.generations,
                    grouped(static_cast<long long>(tree_.vessels())), quantity(r.root_radius, "m"),
                    quantity(r.root_radius * std::pow(r.random_splits() ? 0.5 : r.narrower_share(r.asymmetry),
                                                      (r.generations - 1) / r.exponent),
                             "m", 3),
                    r.random_splits() ? " where splits are even" : "", text_of(r.exponent));
    if (r.random_splits()) text += fmt::format(", random splits (seed {})", r.seed);
    if (r.random_lengths()) text += ", random lengths";
    return text;
  }

  void prepare() override {}

  std::int64_t vessels() const override { return static_cast<std::int64_t>(tree_.vessels()); }

  std::int64_t find(const std::string& name, const std::string& key) const override {
    try {
      return static_cast<std::int64_t>(tree_.id_of(name));
    } catch (const InputError& error) {
      throw InputError(error.what(), key);
    }
  }

  NetworkSolution solve(const Progress& progress, VesselVisitor* visitor) override {
    NetworkSolution s;
    double spent = 0;
    {
      const Stopwatch watch(spent);
      flow_.emplace(tree_, mechanics_.viscosity, driving_boundary(problem_, tree_, mechanics_.hydrostatic),
                    comm_, visitor != nullptr && mechanics_.variation.varies());
    }
    progress(fmt::format("  flow found in {} ({} a vessel)", duration(spent), per_vessel(spent)));
    s.flow = measure();
    check_flow(s, {s.flow.lowest_pressure, s.flow.highest_pressure});
    const bool sweeps = problem_.network.statistics || visitor != nullptr;
    // Where every vessel of a generation is alike one of them is computed: next to nothing.
    if (!problem_.tree.repeats())
      s.flow.flop = static_cast<double>(tree_.places()) * (flop_up + (sweeps ? flop_down : 0));
    if (sweeps) sweep(s, progress, visitor);
    for (const std::string& name : problem_.network.query) {
      s.queries.push_back(vessel(static_cast<std::int64_t>(tree_.id_of(name))));
      s.queries.back().name = name;
    }
    show(s.display);
    return s;
  }

  NetworkVessel vessel(std::int64_t number) const override {
    const network::TreeVessel v = tree_.vessel(static_cast<std::uint64_t>(number));
    const VesselFlow f = flow_->query(v.id);
    const network::WallFactors wall = mechanics_.variation.of(v.kind, TreePair::place_of(v.id));
    NetworkVessel q;
    q.name = TreePair::path_of(v.id);
    q.vessel = number;
    q.kind = v.kind;
    q.generation = v.generation;
    q.radius = v.radius;
    q.length = v.length;
    q.wall_thickness = v.wall_thickness * wall.thickness;
    q.strength_factor = wall.strength;
    q.flow = f.flow;
    q.pressure_from = f.pressure_from + weight(v.start);
    q.pressure_to = f.pressure_to + weight(v.end);
    q.start = v.start;
    q.end = v.end;
    return q;
  }

  std::unique_ptr<VesselInNetwork> vessel_in_network(std::int64_t number) const override {
    return vessel_in_tree(*flow_, static_cast<std::uint64_t>(number));
  }

 private:
  static std::string text_of(double value) { return rhexis::text(value); }
  std::string per_vessel(double seconds) const {
    return fmt::format("{:.3g} ns", 1e9 * seconds / static_cast<double>(tree_.vessels()));
  }
  double weight(const network::Point& p) const { return mechanics_.hydrostatic.pressure(p[0], p[1], p[2]); }

  NetworkFlow measure() const {
    NetworkFlow f;
    f.vessels = static_cast<std::int64_t>(tree_.vessels());
    f.junctions = static_cast<std::int64_t>(tree_.junctions());
    f.solver = problem_.tree.repeats() ? "recursion, one vessel a generation" : "recursion";
    f.inflow = std::abs(flow_->flow());
    f.highest_pressure = std::max(flow_->inlet_pressure(), flow_->outlet_pressure());
    f.lowest_pressure = std::min(flow_->inlet_pressure(), flow_->outlet_pressure());
    const Viscosity& viscosity = mechanics_.viscosity;
    for (const network::VesselKind kind : {network::VesselKind::artery, network::VesselKind::vein}) {
      const double radius = tree_.vessel(TreePair::id_of(1, kind)).radius;
      const double eta = apparent_viscosity(viscosity, radius, viscosity.haematocrit);
      f.highest_reynolds = std::max(f.highest_reynolds,
                                    reynolds_number(radius, eta, f.inflow, mechanics_.hydrostatic.density));
    }
    return f;
  }

  /// All vessels stream by once, for the statistics and the visitor.
  void sweep(NetworkSolution& s, const Progress& progress, VesselVisitor* visitor) const {
    double spent = 0;
    {
      const Stopwatch watch(spent);
      std::function<VesselConsumer&(int)> visit;
      if (visitor != nullptr)
        visit = [&](int thread) -> VesselConsumer& { return visitor->consumer(thread); };
      if (problem_.network.statistics) {
        s.statistics = gather_statistics(*flow_, mechanics_.viscosity, comm_, visit);
      } else {
        flow_->sweep(visit);
      }
    }
    progress(fmt::format("  {} of all vessels in {} ({} a vessel)",
                         visitor == nullptr ? "statistics"
                         : !s.statistics    ? visitor->name()
                                            : fmt::format("statistics and {}", visitor->name()),
                         duration(spent), per_vessel(spent)));
    if (mechanics_.hydrostatic.acts()) {
      s.warnings.push_back(
          "statistics by generation and screening leave out the weight of blood; stored and queried vessels "
          "have it");
    }
    if (s.statistics) conclude_from_statistics(s);
  }

  void conclude_from_statistics(NetworkSolution& s) const {
    s.flow.volume = s.statistics->volume;
    s.flow.surface = s.statistics->surface;
    s.flow.max_imbalance = worst_generation(*s.statistics, s.flow.inflow);
    if (s.statistics->narrow_vessels > 0) {
      s.warnings.push_back(
          fmt::format("{} vessels are narrower than blood.least_diameter, {}, and have the viscosity there",
                      grouped(static_cast<long long>(s.statistics->narrow_vessels)),
                      quantity(2 * mechanics_.viscosity.least_radius(), "m")));
    }
  }

  void show(NetworkDisplay& display) const {
    const std::uint64_t top = TreePair::place_of(tree_.id_of(problem_.network.shown_subtree));
    const auto most = static_cast<std::size_t>(problem_.network.shown_vessels.value_or(20000));
    const auto places = network::widest_places(tree_, top, std::max<std::size_t>(1, most / 2));
    std::vector<std::uint64_t> numbers;
    for (const auto& p : places) numbers.push_back(p.place);
    const auto flows = flow_->at(numbers);
    if (comm_.is_root()) display.lines = VesselLines::of_tree(*flow_, places, flows, mechanics_);
    display.shown = 2 * static_cast<std::int64_t>(places.size());
    // To the sides no more is known than that no vessel is farther away than the heart from the midplane.
    const double reach = -tree_.inlet()[0];
    display.extent.emplace();
    display.extent->fill({-reach, reach});
  }

  FlowProblem problem_;
  parallel::Communicator comm_;
  TreePair tree_;
  VesselMechanics mechanics_;
  std::optional<TreeFlow> flow_;
};

}  // namespace

std::unique_ptr<FlowSolver> make_implicit_solver(FlowProblem problem, parallel::Communicator comm) {
  return std::make_unique<ImplicitSolver>(std::move(problem), comm);
}

}  // namespace rhexis::hemodynamics
