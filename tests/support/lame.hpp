// Static expansion of the wall under a small pressure, in plane strain, against Lame:
//   u_r = (1 + nu)/E P r0^2 / (r1^2 - r0^2) ((1 - 2 nu) r + r1^2 / r).
#pragma once

#include <gtest/gtest.h>

#include "peridynamics/time_steps.hpp"
#include "support/vessels.hpp"

namespace rhexis::test {

inline double lame(const peridynamics::Parameters& p, double pressure, double r) {
  const double nu = p.law.poisson_ratio;
  const double inner2 = p.inner_radius * p.inner_radius, outer2 = p.outer_radius * p.outer_radius;
  return (1 + nu) / p.young_modulus * pressure * inner2 / (outer2 - inner2) * ((1 - 2 * nu) * r + outer2 / r);
}

/// Relative L2 error of the radial displacement over the wall, at rest under `pressure` (Pa), which must
/// be small.
inline double lame_error(peridynamics::Parameters p, double pressure, int steps) {
  using namespace peridynamics;
  p.ends = "axial_periodic";
  resolve(p);
  Lattice lattice = make_lattice(p);
  BondFamilies families = make_families(lattice);
  const double step = 0.9 * stable_time_step(p, lattice, families);
  const BodySetup setup = make_setup(p, std::move(lattice), std::move(families), step);
  const auto body = make_body(BodySetup(setup), self());
  // Dynamic relaxation: velocities are dropped whenever the kinetic energy has passed a peak.
  const auto still = sample(*body, nothing);
  double before = 0;
  for (int i = 0; i < steps; ++i) {
    body->advance(pressure, pressure);
    if (i % 5 != 0) continue;
    body->observe(pressure);
    const double kinetic = body->totals().kinetic;
    if (kinetic < before) {
      const auto u = body->displacement();
      body->set_state(
          {std::vector<double>(u[0].begin(), u[0].end()), std::vector<double>(u[1].begin(), u[1].end()),
           std::vector<double>(u[2].begin(), u[2].end())},
          still);
      before = 0;
    } else {
      before = kinetic;
    }
  }
  body->observe(pressure);
  EXPECT_LT(body->totals().kinetic, 1e-5 * body->totals().strain) << "not at rest";

  double error = 0, size = 0;
  const PointLayout& l = body->layout();
  for (std::int64_t c = 0; c < l.columns; ++c) {
    const auto x = body->reference_position(c, 0);
    const double r = std::hypot(x[0], x[1]);
    const auto i = static_cast<std::size_t>(c * l.rows);
    const double u = (body->displacement()[0][i] * x[0] + body->displacement()[1][i] * x[1]) / r;
    const double exact = lame(p, pressure, r);
    const double area = setup.lattice.section.area[static_cast<std::size_t>(c)];
    error += area * (u - exact) * (u - exact);
    size += area * exact * exact;
  }
  return std::sqrt(error / size);
}

}  // namespace rhexis::test
