// SPDX-License-Identifier: BSD-3-Clause
// The wall at rest under a small pressure, in plane strain, against Lame.
#pragma once

#include <gtest/gtest.h>

#include <iostream>

#include "peridynamics/stability/time_steps.hpp"
#include "peridynamics/statics/elastic_error.hpp"
#include "support/vessels.hpp"

namespace rhexis::test {

/// As elastic_error, of the engine brought to rest in so many steps.
inline peridynamics::ElasticError error_at_rest(const peridynamics::Parameters& p,
                                                peridynamics::BodySetup setup, int steps) {
  setup.time_step = 0.6 * peridynamics::stable_time_step(setup);
  const auto body = peridynamics::make_body(peridynamics::BodySetup(setup), self());
  const double pressure = 500;  // strains of 5e-4: small
  bring_to_rest(*body, pressure, steps);
  EXPECT_LT(body->totals().kinetic, 1e-5 * body->totals().strain) << "not at rest";

  double error = 0, size = 0, least = INFINITY, most = 0;
  const peridynamics::ColumnLayout& l = *body->columns();
  for (std::int64_t c = 0; c < l.columns; ++c) {
    const auto x = body->reference_position(l.particle(c, 0));
    const double r = std::hypot(x[0], x[1]);
    const auto i = static_cast<std::size_t>(c * l.rows);
    const double u = (body->displacement()[0][i] * x[0] + body->displacement()[1][i] * x[1]) / r;
    const double exact = peridynamics::lame_displacement(p, pressure, r);
    const double area = setup.lattice.section.area[static_cast<std::size_t>(c)];
    error += area * (u - exact) * (u - exact);
    size += area * exact * exact;
    least = std::min(least, u / exact);
    most = std::max(most, u / exact);
  }
  return {std::sqrt(error / size), most / least - 1};
}

/// The error found without a run is the one that the docs state.
inline void expect_stated_error(const peridynamics::Parameters& p, double error, double spread) {
  const peridynamics::ElasticError e = peridynamics::elastic_error(p, setup_of(p, 1e-7)).value();
  std::cout << "error " << e.relative_l2 << ", spread " << e.spread << '\n';
  EXPECT_NEAR(e.relative_l2, error, 0.02 * error);
  EXPECT_NEAR(e.spread, spread, 0.04 * spread);
}

/// The engine, brought to rest in so many steps, is where the linear solution says.
inline void expect_engine_at_linear_solution(const peridynamics::Parameters& p, int steps) {
  const peridynamics::BodySetup setup = setup_of(p, 1e-7);
  const peridynamics::ElasticError engine = error_at_rest(p, setup, steps),
                                   linear = peridynamics::elastic_error(p, setup).value();
  EXPECT_NEAR(engine.relative_l2, linear.relative_l2, 0.002);
  EXPECT_NEAR(engine.spread, linear.spread, 0.002);
}

}  // namespace rhexis::test
