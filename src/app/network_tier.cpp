#include "app/network_tier.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "hemodynamics/poiseuille.hpp"

namespace rhexis::app {

namespace {

std::unique_ptr<NetworkTier> make_tier(const Configuration& c, parallel::Communicator comm) {
  const bool is_tree = c.network.source == "tree";
  if (c.network.tier == "implicit" || (c.network.tier == "auto" && is_tree))
    return make_implicit_tier(c, comm);
  if (c.network.tier == "distributed") return make_distributed_tier(c, comm);
  return make_explicit_tier(c, comm);
}

}  // namespace

std::unique_ptr<NetworkTier> prepared_tier(const Configuration& c, parallel::Communicator comm) {
  auto tier = make_tier(c, comm);
  try {
    tier->prepare();
  } catch (const InputError& error) {
    throw input::located(error, c.resolved);
  }
  return tier;
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
  const auto [low, high] = driving;
  if (!(high - low > 1e-12 * std::max(std::abs(low), std::abs(high))))
    s.warnings.push_back("nothing flows: no difference of pressure drives blood through the network");
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
