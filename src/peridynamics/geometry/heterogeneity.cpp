// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/geometry/heterogeneity.hpp"

#include <algorithm>
#include <cmath>

#include "core/lognormal.hpp"
#include "core/weibull.hpp"
#include "parallel/communicator.hpp"
#include "parallel/threads.hpp"

namespace rhexis::peridynamics {

Heterogeneity::Heterogeneity(const Parameters& p)
    : mid_radius_(0.5 * (p.inner_radius + p.outer_radius)), spots_(p.spots) {
  uniform_ = p.scatter.none() && std::ranges::all_of(spots_.list, [](const Spot& spot) {
               return spot.stiffness == 1 && spot.critical_stretch == 1;
             });
  if (p.scatter.none()) return;
  field_.emplace(p.scatter.seed, *p.scatter.correlation_length);
  critical_stretch_ = marginal(p.scatter.law, p.scatter.critical_stretch);
  stiffness_ = marginal(p.scatter.law, p.scatter.stiffness);
}

Heterogeneity::Marginal Heterogeneity::marginal(ScatterLaw law, double spread) {
  if (spread == 0) return [](double) { return 1.0; };
  if (law == ScatterLaw::weibull) return [w = Weibull(spread)](double z) { return w.of_normal(z); };
  return [l = Lognormal(spread)](double z) { return l.of_normal(z); };
}

std::vector<LocalFactors> Heterogeneity::along(double x, double y, std::span<const double> z) const {
  std::vector<LocalFactors> factors(z.size());
  if (field_) {
    const std::vector<GaussianField::Pair> drawn = field_->along(x, y, z);
    for (std::size_t i = 0; i < z.size(); ++i)
      factors[i] = {critical_stretch_(drawn[i][0]), stiffness_(drawn[i][1])};
  }
  const double angle = std::atan2(y, x);
  for (const Spot& spot : spots_.list) {
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double near = spots_.nearness(spot, mid_radius_, angle, z[i]);
      factors[i].critical_stretch *= 1 + (spot.critical_stretch - 1) * near;
      factors[i].stiffness *= 1 + (spot.stiffness - 1) * near;
    }
  }
  return factors;
}

LocalFactors Heterogeneity::largest(const Lattice& lattice) const {
  if (uniform()) return {};
  std::vector<double> z(static_cast<std::size_t>(lattice.rows));
  for (std::int64_t row = 0; row < lattice.rows; ++row)
    z[static_cast<std::size_t>(row)] = lattice.height(row);
  const int threads = parallel::thread_count();
  std::vector<LocalFactors> largest(static_cast<std::size_t>(threads), LocalFactors{0, 0});
  const auto raise = [](LocalFactors& to, const LocalFactors& f) {
    to = {std::max(to.critical_stretch, f.critical_stretch), std::max(to.stiffness, f.stiffness)};
  };
  parallel::for_each_share(
      threads, lattice.section.size(), [&](int thread, std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
          for (const LocalFactors& f : along(lattice.section.x[c], lattice.section.y[c], z))
            raise(largest[thread], f);
        }
      });
  for (const LocalFactors& f : largest) raise(largest.front(), f);
  return largest.front();
}

}  // namespace rhexis::peridynamics
