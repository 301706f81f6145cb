// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/tree/changed_tree.hpp"

#include <algorithm>
#include <map>

#include "core/error.hpp"
#include "hemodynamics/steady/graph/graph_flow.hpp"

namespace rhexis::hemodynamics {
namespace {

using network::TreePair;
using network::VesselKind;

/// Balanced far beyond what a leak's effect on the rest needs.
constexpr double imbalance = 1e-14;

/// The ways as an explicit graph, grown vessel by vessel.
struct Ways {
  network::Graph graph;
  std::vector<double> conductance;
  std::vector<network::BoundaryCondition> conditions;

  std::uint32_t junction() { return static_cast<std::uint32_t>(graph.junctions++); }
  std::size_t join(std::uint32_t from, std::uint32_t to, double resistance) {
    graph.from.push_back(from);
    graph.to.push_back(to);
    conductance.push_back(1 / resistance);
    return conductance.size() - 1;
  }
};

}  // namespace

ChangedTree::ChangedTree(const TreeFlow& flow, std::vector<std::uint64_t> vessels)
    : flow_(flow), vessels_(std::move(vessels)) {
  std::map<std::uint64_t, Place> places;
  std::map<std::uint64_t, double> beside;  // of daughters that hang off a way
  for (std::size_t i = 0; i < vessels_.size(); ++i) {
    flow.tree().vessel(vessels_[i]);  // throws for one that is not there
    if (std::count(vessels_.begin(), vessels_.end(), vessels_[i]) > 1) {
      throw InputError("vessel " + std::to_string(vessels_[i]) + " is named twice");
    }
    const std::uint64_t place = TreePair::place_of(vessels_[i]);
    const TreeFlow::Path path = flow.path_to(place);
    const std::size_t length = path.artery.size();
    for (std::size_t g = 0; g < length; ++g) {
      const std::uint64_t here = place >> (length - 1 - g);
      auto& p = places[here];
      p.place = here;
      p.artery = path.artery[g];
      p.vein = path.vein[g];
      if (g + 1 < length) {
        beside[(place >> (length - 2 - g)) ^ 1] = path.beside[g];
      } else {
        p.below = path.below;
      }
    }
  }
  for (auto& [here, p] : places) {
    const bool left = places.contains(2 * here), right = places.contains(2 * here + 1);
    if (left && right) p.below = 0;
    if (left != right) p.below = beside.at(2 * here + (left ? 1 : 0));
    places_.push_back(p);
  }
}

ChangedTree::Result ChangedTree::solve(const std::vector<VesselChange>& changes) const {
  Ways ways;
  Result result;
  std::map<std::uint64_t, const VesselChange*> change_of;
  for (const VesselChange& change : changes) {
    if (std::find(vessels_.begin(), vessels_.end(), change.vessel) == vessels_.end() ||
        !change_of.emplace(change.vessel, &change).second) {
      throw InputError("vessel " + std::to_string(change.vessel) + " was not announced, or is changed twice");
    }
  }
  struct Ends {
    std::uint32_t artery, vein;
  };
  std::map<std::uint64_t, Ends> far;
  struct Halves {
    std::size_t first = 0, second = 0;  ///< vessels of the graph, in the direction of flow
  };
  std::map<std::uint64_t, Halves> halves;
  const auto put = [&](std::uint64_t id, std::uint32_t from, std::uint32_t to, double resistance) {
    const auto found = change_of.find(id);
    if (found == change_of.end()) return Halves{ways.join(from, to, resistance), ways.conductance.size() - 1};
    const VesselChange& change = *found->second;
    const std::uint32_t middle = ways.junction();
    const double half = resistance * change.resistance_factor / 2;
    const Halves h{ways.join(from, middle, half), ways.join(middle, to, half)};
    if (change.leak_conductance > 0) {
      ways.conditions.push_back({middle, network::BoundaryCondition::Kind::pressure, change.outside_pressure,
                                 1 / change.leak_conductance});
    }
    halves[id] = h;
    return h;
  };
  const Ends roots{ways.junction(), ways.junction()};
  for (const network::BoundaryCondition& c : conditions_of(flow_.boundary(), roots.artery, roots.vein))
    ways.conditions.push_back(c);
  Halves first_artery, last_vein;
  for (const Place& p : places_) {
    const Ends near = p.place == 1 ? roots : far.at(p.place / 2);
    const bool last_generation = 2 * p.place > flow_.tree().places();
    Ends ends{ways.junction(), 0};
    ends.vein = last_generation ? ends.artery : ways.junction();
    far[p.place] = ends;
    const Halves artery =
        put(TreePair::id_of(p.place, VesselKind::artery), near.artery, ends.artery, p.artery);
    const Halves vein = put(TreePair::id_of(p.place, VesselKind::vein), ends.vein, near.vein, p.vein);
    if (p.place == 1) {
      first_artery = artery;
      last_vein = vein;
    }
    if (p.below > 0) ways.join(ends.artery, ends.vein, p.below);
  }
  const GraphFlow flow = solve_flow(ways.graph, ways.conductance, ways.conditions, {.imbalance = imbalance});
  result.inflow = flow.flow[first_artery.first];
  result.outflow = flow.flow[last_vein.second];
  for (const VesselChange& change : changes) {
    const Halves h = halves.at(change.vessel);
    const double middle = flow.pressure[ways.graph.to[h.first]];
    result.vessels.push_back({.flow_from = flow.flow[h.first],
                              .flow_to = flow.flow[h.second],
                              .leak = change.leak_conductance * (middle - change.outside_pressure),
                              .pressure_from = flow.pressure[ways.graph.from[h.first]],
                              .pressure_middle = middle,
                              .pressure_to = flow.pressure[ways.graph.to[h.second]]});
  }
  return result;
}

}  // namespace rhexis::hemodynamics
