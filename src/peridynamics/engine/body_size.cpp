// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/engine/body_size.hpp"

#include <algorithm>
#include <numbers>

#include "peridynamics/geometry/heterogeneity.hpp"

namespace rhexis::peridynamics {

BodySize body_size(const Parameters& p, const WallSize& wall, double rows, int ranks) {
  // Halos lie on both sides of a rank's columns, where the section is dealt out.
  const double halo =
      ranks > 1
          ? std::min(wall.columns, 2 * wall.columns * *p.horizon / (2 * std::numbers::pi * p.inner_radius))
          : 0;
  return {.columns = wall.columns,
          .rows = rows,
          .bonds = wall.bonds,
          .halo_columns = ranks * halo,
          .ranks = ranks,
          .lumen_nodes =
              p.direction == LoadDirection::follower ? 2 * std::numbers::pi * p.inner_radius / *p.spacing : 0,
          .heterogeneous = !Heterogeneity(p).uniform(),
          .thinned = p.spots.thin_the_wall()};
}

}  // namespace rhexis::peridynamics
