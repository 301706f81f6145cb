// SPDX-License-Identifier: BSD-3-Clause
// Static equilibria against laws that hold for any discretisation.
#include "peridynamics/statics/equilibrium.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "support/vessels.hpp"

namespace rhexis::peridynamics {
namespace {

class Equilibria : public testing::TestWithParam<const char*> {
 protected:
  BodySetup setup() const {
    Parameters p = test::paper_vessel(1.6e-3);
    p.spacing = 1.6e-4;
    p.horizon = 4e-4;
    p.cross_section = Arrangement::polar;
    p.ends = value_of<EndCondition>(GetParam()).value();
    p.layer = LayerForce::consistent;
    p.bond_precision = Precision::double_precision;
    return test::setup_of(p, 1e-7);
  }
};
INSTANTIATE_TEST_SUITE_P(Ends, Equilibria, testing::Values("clamped", "sliding", "axial_periodic", "free"));

/// sum b . u V per unit of pressure, m3: the volume that the pressure has swept.
double swept(const BodySetup& s, const Equilibrium& e) {
  double sum = 0;
  for (std::size_t i = 0; i < e.displacement[0].size(); ++i) {
    const std::size_t c = i / static_cast<std::size_t>(s.lattice.rows);
    sum +=
        s.lattice.volume(c) * (s.layer.bx[c] * e.displacement[0][i] + s.layer.by[c] * e.displacement[1][i]);
  }
  return sum;
}

TEST_P(Equilibria, SmallOnesStoreHalfOfPressureTimesSweptVolume) {
  const BodySetup s = setup();
  const double pressure = 10;
  const Equilibrium e = find_equilibrium(s, pressure, 1e-7, test::self());
  std::printf("%s: %ld steps\n", GetParam(), e.steps);
  EXPECT_GT(e.strain_energy, 0);
  EXPECT_NEAR(e.strain_energy / (0.5 * pressure * swept(s, e)), 1, 1e-4);  // Clapeyron
}

TEST_P(Equilibria, StrainEnergyIsTheWorkOfASlowlyRisingPressure) {
  const BodySetup s = setup();
  const double pressure = 150e3;
  const int parts = 4;
  double work = 0, before = 0;
  Equilibrium e;
  for (int i = 1; i <= parts; ++i) {
    e = find_equilibrium(s, pressure * i / parts, 1e-5, test::self());
    const double now = swept(s, e);
    work += (i - 0.5) / parts * pressure * (now - before);
    before = now;
  }
  EXPECT_NEAR(e.strain_energy / work, 1, 5e-3) << "but for the trapezoidal rule";
}

TEST_P(Equilibria, AWallSetIntoOneStaysThere) {
  const BodySetup s = setup();
  const double pressure = 100e3;
  const Equilibrium e = find_equilibrium(s, pressure, 1e-6, test::self());
  const auto body = make_body(BodySetup(s), test::self());
  body->set_state(e.displacement, test::sample(*body, test::nothing));
  for (int i = 0; i < 300; ++i) body->advance(pressure, pressure);
  body->observe(pressure);
  EXPECT_NEAR(body->totals().strain / e.strain_energy, 1, 1e-5);
  EXPECT_LT(body->totals().kinetic, 1e-9 * e.strain_energy);
}

TEST(Equilibrium, FailsWhereItIsNotReached) {
  Parameters p = test::paper_vessel(1e-3);
  p.ends = EndCondition::axial_periodic;
  EXPECT_THROW(find_equilibrium(test::setup_of(p, 1e-7), 1e3, 1e-4, test::self(), 10), RunError);
}

}  // namespace
}  // namespace rhexis::peridynamics
