#include "app/network_tier.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/format.hpp"
#include "core/memory.hpp"
#include "hemodynamics/poiseuille.hpp"
#include "network/tree_pair.hpp"
#include "parallel/node.hpp"
#include "parallel/together.hpp"

namespace rhexis::app {

namespace {

std::unique_ptr<NetworkTier> make_tier(const Configuration& c, parallel::Communicator comm) {
  const bool is_tree = c.network.source == "tree";
  if (c.network.tier == "implicit" || (c.network.tier == "auto" && is_tree))
    return make_implicit_tier(c, comm);
  if (c.network.tier == "distributed") return make_distributed_tier(c, comm);
  return make_explicit_tier(c, comm);
}

bool is_built_tree(const Configuration& c) {
  return c.network.source == "tree" && (c.network.tier == "explicit" || c.network.tier == "distributed");
}

/// Throws InputError where a rank's share of a tree's vessels cannot be numbered, or held in memory.
/// `ranks_here`: that share the memory of this machine.
void check_size(const Configuration& c, int ranks, int ranks_here) {
  const bool distributed = c.network.tier == "distributed";
  const double vessels =
      static_cast<double>(network::TreePair::vessels_of(c.tree.generations)) / (distributed ? ranks : 1);
  const MemoryLimit memory = available_memory();
  const int sharing = distributed && memory.of_machine ? ranks_here : 1;
  const double bytes = vessels * bytes_per_vessel;
  if (vessels < 0x1p31 && sharing * bytes < memory.bytes) return;
  throw InputError(
      fmt::format("this tree takes some {:.3g} GB on a rank{}, and {:.3g} GB is left by {}; {} \"implicit\"",
                  1e-9 * bytes, sharing > 1 ? fmt::format(", {} of them here", sharing) : "",
                  1e-9 * memory.bytes, memory.source, distributed ? "take more ranks, or" : "take"),
      "network.tier");
}

std::unique_ptr<NetworkTier> made_tier(const Configuration& c, parallel::Communicator comm,
                                       bool trees_are_built) {
  auto tier = make_tier(c, comm);
  try {
    if (is_built_tree(c)) {
      const int ranks_here = parallel::ranks_of_node(comm);
      parallel::together<InputError>(comm, [&] { check_size(c, comm.size(), ranks_here); });
    }
    if (trees_are_built || !is_built_tree(c)) tier->prepare();
  } catch (const InputError& error) {
    throw input::located(error, c.resolved);
  }
  return tier;
}

}  // namespace

std::unique_ptr<NetworkTier> checked_tier(const Configuration& c, parallel::Communicator comm) {
  return made_tier(c, comm, false);
}

std::unique_ptr<NetworkTier> prepared_tier(const Configuration& c, parallel::Communicator comm) {
  return made_tier(c, comm, true);
}

hemodynamics::TreeBoundary driving_boundary(const Configuration& c, const network::TreePair& tree,
                                            const hemodynamics::Hydrostatic& hydrostatic) {
  const auto weight = [&](const network::Point& p) { return hydrostatic.pressure(p[0], p[1], p[2]); };
  hemodynamics::TreeBoundary b = hemodynamics::tree_boundary(c.hemodynamics);
  if (b.inlet_pressure) *b.inlet_pressure -= weight(tree.inlet());
  if (b.outlet_pressure) *b.outlet_pressure -= weight(network::TreePair::mirrored(tree.inlet()));
  return b;
}

void check_flow(NetworkSolution& s, const std::array<double, 2>& driving) {
  if (!std::isfinite(s.inflow))
    throw RunError("the flow of this network cannot be computed: it came out as " + text(s.inflow) + " m3/s");
  const auto [low, high] = driving;
  if (!(high - low > 1e-12 * std::max(std::abs(low), std::abs(high))))
    s.warnings.push_back("nothing flows: no difference of pressure drives blood through the network");
  constexpr double atmosphere = 101325;  // Pa; pressures are told from it
  if (s.lowest_pressure < -atmosphere) {
    s.warnings.push_back(fmt::format(
        "the pressure falls to {}, below vacuum at {}: no fluid flows so; check the flows that are given",
        mmhg(s.lowest_pressure), mmhg(-atmosphere)));
  } else if (s.lowest_pressure < -1e-9 * (high - low)) {
    s.warnings.push_back(fmt::format(
        "the pressure falls to {}, below that around the vessels: real ones would collapse, these are rigid",
        mmhg(s.lowest_pressure)));
  }
  if (s.highest_reynolds > hemodynamics::laminar_reynolds_number) {
    s.warnings.push_back(
        fmt::format("the Reynolds number reaches {:.0f}; above {:.0f} flow is not laminar, and real "
                    "resistances are higher than those of Eq. (9)",
                    s.highest_reynolds, hemodynamics::laminar_reynolds_number));
  }
}

hemodynamics::VesselMechanics mechanics_of(const Configuration& c) {
  const network::WallParameters& w = c.network.wall;
  hemodynamics::VesselMechanics m{.artery_wall = network::artery_wall(w),
                                  .vein_wall = network::vein_wall(w),
                                  .variation = network::WallVariation(c.network.weakness),
                                  .numbered_by_id = c.network.source == "tree",
                                  .young_modulus = w.young_modulus,
                                  .poisson_ratio = w.poisson_ratio,
                                  .viscosity = c.hemodynamics.viscosity,
                                  .hydrostatic = {c.hemodynamics.density, {}}};
  std::copy(c.hemodynamics.acceleration.begin(), c.hemodynamics.acceleration.end(),
            m.hydrostatic.acceleration.begin());
  if (c.network.source == "tree") m.variation.mark_in_tree(c.network.weakness, c.tree.generations);
  return m;
}

screening::Criterion criterion_of(const Configuration& c) {
  screening::Criterion criterion{c.screening.critical_stretch, c.network.wall.young_modulus,
                                 c.network.wall.poisson_ratio, 0};
  if (c.is_coupled()) {
    criterion.outside_pressure = coupling::outside_everywhere(c.coupling);
  }
  return criterion;
}

const char* kind_text(network::VesselKind kind) {
  return kind == network::VesselKind::artery ? "artery"
         : kind == network::VesselKind::vein ? "vein"
                                             : "vessel";
}

}  // namespace rhexis::app
