// Tier 1: the tree pair by recursion; nothing is stored.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/network_tier.hpp"
#include "core/format.hpp"
#include "core/stopwatch.hpp"
#include "hemodynamics/poiseuille.hpp"
#include "hemodynamics/steady/tree/tree_flow.hpp"
#include "hemodynamics/viscosity.hpp"
#include "network/tree_selection.hpp"
#include "runtime/console.hpp"

namespace rhexis::app {
namespace {

using hemodynamics::TreeFlow;
using network::TreePair;

/// Blood through every generation against the inflow: what the sweep itself shows of conservation.
double worst_generation(const hemodynamics::TreeStatistics& s, double inflow) {
  double worst = 0;
  for (const auto& g : s.generations)
    worst = std::max(worst, std::abs(std::abs(g.flow.mean) * g.vessels / inflow - 1));
  return inflow > 0 ? worst : 0;
}

class ImplicitTier : public NetworkTier {
 public:
  ImplicitTier(const Configuration& c, parallel::Communicator comm)
      : c_(c), comm_(comm), tree_(c.tree), mechanics_(mechanics_of(c)) {}

  std::string description() const override {
    const network::TreeRules& r = c_.tree;
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

  NetworkSolution solve(const Say& say) override {
    NetworkSolution s;
    s.vessels = static_cast<std::int64_t>(tree_.vessels());
    s.junctions = static_cast<std::int64_t>(tree_.junctions());
    s.solver = c_.tree.repeats() ? "recursion, one vessel a generation" : "recursion";
    double spent = 0;
    std::optional<TreeFlow>& flow = flow_;
    {
      const Stopwatch watch(spent);
      flow.emplace(tree_, mechanics_.viscosity, driving_boundary(c_, tree_, mechanics_.hydrostatic), comm_,
                   c_.screening.top > 0 && mechanics_.variation.varies());
    }
    say(fmt::format("  flow found in {} ({} a vessel)", duration(spent), per_vessel(spent)));
    s.inflow = std::abs(flow->flow());
    s.highest_pressure = std::max(flow->inlet_pressure(), flow->outlet_pressure());
    s.lowest_pressure = std::min(flow->inlet_pressure(), flow->outlet_pressure());
    for (const network::VesselKind kind : {network::VesselKind::artery, network::VesselKind::vein}) {
      const double radius = tree_.vessel(TreePair::id_of(1, kind)).radius;
      const double eta =
          hemodynamics::apparent_viscosity(mechanics_.viscosity, radius, mechanics_.viscosity.haematocrit);
      s.highest_reynolds =
          std::max(s.highest_reynolds,
                   hemodynamics::reynolds_number(radius, eta, s.inflow, mechanics_.hydrostatic.density));
    }
    check_flow(s, {s.lowest_pressure, s.highest_pressure});
    const bool sweeps = c_.network.statistics || c_.screening.top > 0;
    // Where every vessel of a generation is alike one of them is computed: next to nothing.
    if (!c_.tree.repeats()) {
      s.flop = static_cast<double>(tree_.places()) *
               (hemodynamics::flop_up + (sweeps ? hemodynamics::flop_down : 0));
    }
    if (sweeps) sweep(*flow, s, say);
    for (const std::string& name : c_.network.query) s.queries.push_back(query(*flow, name));
    show(*flow, s);
    return s;
  }

  std::unique_ptr<hemodynamics::VesselInNetwork> vessel(const QueriedVessel& queried) override {
    return hemodynamics::vessel_in_tree(*flow_, static_cast<std::uint64_t>(queried.vessel));
  }

 private:
  static std::string text_of(double value) { return rhexis::text(value); }
  std::string per_vessel(double seconds) const {
    return fmt::format("{:.3g} ns", 1e9 * seconds / static_cast<double>(tree_.vessels()));
  }
  double weight(const network::Point& p) const { return mechanics_.hydrostatic.pressure(p[0], p[1], p[2]); }

  /// Statistics and screening, in one go.
  void sweep(const TreeFlow& flow, NetworkSolution& s, const Say& say) const {
    double spent = 0;
    {
      const Stopwatch watch(spent);
      std::optional<screening::TreeScreening> screening;
      std::function<hemodynamics::VesselConsumer&(int)> screen;
      if (c_.screening.top > 0) {
        screening.emplace(tree_, mechanics_.variation, criterion_of(c_),
                          static_cast<std::size_t>(c_.screening.top));
        screen = [&](int thread) -> hemodynamics::VesselConsumer& { return screening->consumer(thread); };
      }
      if (c_.network.statistics) {
        s.statistics = hemodynamics::gather_statistics(flow, mechanics_.viscosity, comm_, screen);
      } else {
        flow.sweep(screen);
      }
      if (screening) s.screening = screening->result(comm_);
    }
    say(fmt::format("  {} of all vessels in {} ({} a vessel)",
                    !s.screening    ? "statistics"
                    : !s.statistics ? "screening"
                                    : "statistics and screening",
                    duration(spent), per_vessel(spent)));
    if (s.screening) {
      for (const screening::RankedVessel& v : s.screening->top)
        s.at_risk.push_back(query(flow, TreePair::path_of(v.vessel)));
    }
    if (mechanics_.hydrostatic.acts()) {
      s.warnings.push_back(
          "statistics by generation and screening leave out the weight of blood; stored and queried vessels "
          "have it");
    }
    if (s.statistics) take_statistics(s);
  }

  void take_statistics(NetworkSolution& s) const {
    s.volume = s.statistics->volume;
    s.surface = s.statistics->surface;
    s.max_imbalance = worst_generation(*s.statistics, s.inflow);
    if (s.statistics->narrow_vessels > 0) {
      s.warnings.push_back(
          fmt::format("{} vessels are narrower than blood.least_diameter, {}, and have the viscosity there",
                      grouped(static_cast<long long>(s.statistics->narrow_vessels)),
                      quantity(mechanics_.viscosity.least_diameter, "m")));
    }
  }

  QueriedVessel query(const TreeFlow& flow, const std::string& name) const {
    const network::TreeVessel v = tree_.vessel(tree_.id_of(name));
    const hemodynamics::VesselFlow f = flow.query(v.id);
    const network::WallFactors wall = mechanics_.variation.of(v.kind, TreePair::place_of(v.id));
    return {.name = name,
            .vessel = static_cast<std::int64_t>(v.id),
            .kind = v.kind,
            .generation = v.generation,
            .radius = v.radius,
            .length = v.length,
            .wall_thickness = v.wall_thickness * wall.thickness,
            .strength_factor = wall.strength,
            .flow = f.flow,
            .pressure_from = f.pressure_from + weight(v.start),
            .pressure_to = f.pressure_to + weight(v.end),
            .start = v.start,
            .end = v.end};
  }

  void show(const TreeFlow& flow, NetworkSolution& s) const {
    const std::uint64_t top = TreePair::place_of(tree_.id_of(c_.network.shown_subtree));
    const auto most = static_cast<std::size_t>(c_.network.shown_vessels.value_or(20000));
    const auto places = network::widest_places(tree_, top, std::max<std::size_t>(1, most / 2));
    std::vector<std::uint64_t> numbers;
    for (const auto& p : places) numbers.push_back(p.place);
    const auto flows = flow.at(numbers);
    if (comm_.is_root()) s.lines = hemodynamics::VesselLines::of_tree(flow, places, flows, mechanics_);
    s.shown = 2 * static_cast<std::int64_t>(places.size());
    // To the sides no more is known than that no vessel is farther away than the heart from the midplane.
    const double reach = -tree_.inlet()[0];
    s.extent.emplace();
    s.extent->fill({-reach, reach});
  }

  const Configuration& c_;
  parallel::Communicator comm_;
  TreePair tree_;
  hemodynamics::VesselMechanics mechanics_;
  std::optional<TreeFlow> flow_;
};

}  // namespace

std::unique_ptr<NetworkTier> make_implicit_tier(const Configuration& c, parallel::Communicator comm) {
  return std::make_unique<ImplicitTier>(c, comm);
}

}  // namespace rhexis::app
