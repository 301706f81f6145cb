// SPDX-License-Identifier: BSD-3-Clause
#include "studies/ensemble/walls.hpp"

#include "core/error.hpp"
#include "core/format.hpp"
#include "core/lognormal.hpp"
#include "network/tree/random_stream.hpp"

namespace rhexis::ensemble {

SampledWall draw_wall(const Parameters& p, std::int64_t wall) {
  const auto factor = [&](double spread, network::Stream stream) {
    const std::uint32_t bits =
        network::draw(static_cast<std::uint64_t>(p.seed), stream, static_cast<std::uint64_t>(wall));
    return Lognormal(spread)(network::even_share(bits), network::coin(bits));
  };
  return {.strength = factor(p.strength_spread, network::Stream::wall_strength),
          .thickness = factor(p.thickness_spread, network::Stream::wall_thickness),
          .stiffness = factor(p.stiffness_spread, network::Stream::wall_stiffness)};
}

peridynamics::Parameters with_wall(peridynamics::Parameters v, const SampledWall& f) {
  v.outer_radius += (f.thickness - 1) * (v.outer_radius - v.inner_radius);  // exact where the factor is 1
  *v.critical_stretch *= f.strength;
  peridynamics::scale_stiffness(v, f.stiffness);
  return v;
}

std::vector<std::string> check_walls(const Parameters& p, const peridynamics::Parameters& v) {
  const double mean = v.outer_radius - v.inner_radius;
  std::int64_t thin = 0;
  for (std::int64_t i = 0; i < p.samples; ++i) {
    const double wall = draw_wall(p, i).thickness * mean;
    if (wall < *v.spacing) {
      throw InputError("wall " + std::to_string(i) + " would be " + quantity(wall, "m") +
                           " thick, less than one spacing (" + quantity(*v.spacing, "m") +
                           "); scatter less, or take a smaller discretisation.spacing",
                       "ensemble.thickness_spread");
    }
    if (wall < 2.999 * *v.spacing) ++thin;
  }
  std::vector<std::string> warnings;
  if (p.thickness_spread > 0 && v.cross_section == peridynamics::Arrangement::lattice) {
    warnings.emplace_back(
        "on a lattice, thickness changes by whole columns, so that many walls are alike; "
        "discretisation.cross_section = \"polar\" follows it");
  }
  if (thin > 0 && mean >= 2.999 * *v.spacing) {
    warnings.push_back(std::to_string(thin) + " of " + std::to_string(p.samples) +
                       " walls are less than 3 spacings thick; their stiffness and strength mean little");
  }
  return warnings;
}

}  // namespace rhexis::ensemble
