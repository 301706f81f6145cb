// SPDX-License-Identifier: BSD-3-Clause
// Capillary to aorta, 3 to 40 spacings of wall, 1 Pa to 1 GPa, loads that come at once.
#include <gtest/gtest.h>

#include "robustness/small_tubes.hpp"

namespace rhexis::peridynamics {
namespace {

class Scales : public testing::TestWithParam<bool> {
 protected:
  bool doubles() const { return GetParam(); }
};
INSTANTIATE_TEST_SUITE_P(Bonds, Scales, testing::Values(false, true),
                         [](const auto& i) { return i.param ? "double" : "single"; });

TEST_P(Scales, AnswerDoesNotDependOnTheUnitOfLength) {
  // With the same density and stiffness, a body `scale` times as large does the same `scale` times as slowly.
  const auto outcome = [&](double scale) {
    Parameters p = test::small_tube("polar", doubles());
    for (double* length : {&p.inner_radius, &p.outer_radius, &p.length, &*p.spacing, &*p.horizon})
      *length *= scale;
    p.critical_stretch = 0.1;
    const auto body = make_body(test::setup_at(p, 0.8), test::self());
    for (int i = 0; i < 25; ++i) body->advance(2e6, 2e6);
    body->observe(2e6);
    const Totals t = body->totals();
    EXPECT_GT(t.broken_bonds, 0) << "the test should tear something";
    return std::array{
        t.max_displacement / *p.spacing, t.external_work / (p.young_modulus * std::pow(*p.spacing, 3)),
        t.kinetic / t.external_work,     t.strain / t.external_work,
        t.fracture / t.external_work,    static_cast<double>(t.broken_bonds)};
  };
  const auto usual = outcome(1);
  for (double scale : {1e-6, 1e3}) {
    const auto scaled = outcome(scale);
    double difference = 0;
    for (std::size_t i = 0; i < usual.size(); ++i)
      difference = std::max(difference, std::abs(scaled[i] - usual[i]) / std::max(1.0, usual[i]));
    std::printf("scale %g: %.1e off\n", scale, difference);
    EXPECT_LT(difference, doubles() ? 1e-12 : 1e-5) << scale;
  }
}

TEST_P(Scales, DisplacementIsProportionalToSmallPressures) {
  // At 1 Pa strains are 1e-6: displacements of a millionth of a spacing keep their digits.
  const auto displacement = [&](double pressure) {
    const auto body = make_body(test::setup_at(test::small_tube("polar", doubles()), 0.8), test::self());
    for (int i = 0; i < 100; ++i) body->advance(pressure, pressure);
    return body->max_displacement() / pressure;
  };
  const double at_ten = displacement(10);
  EXPECT_NEAR(displacement(1) / at_ten, 1, 1e-4);
  EXPECT_NEAR(displacement(100) / at_ten, 1, 1e-3);
}

TEST_P(Scales, PressuresBeyondAllStrengthStayFinite) {
  for (double pressure : {1e6, 1e9}) {
    Parameters p = test::small_tube("polar", doubles());
    p.critical_stretch = 0.25;
    p.pressure = pressure;
    p.ends = EndCondition::clamped;
    const auto body = make_body(test::setup_at(p, 0.8), test::self());
    for (int i = 0; i < 500; ++i) body->advance(pressure, pressure);
    body->observe(pressure);
    const Totals t = body->totals();
    EXPECT_GT(t.broken_bonds, 0);
    EXPECT_TRUE(holds_no_more_than_was_put_in(t)) << pressure;
  }
}

TEST_P(Scales, ClampedEndsBearALoadThatComesAtOnce) {
  Parameters p = test::small_tube("lattice", doubles());
  p.ends = EndCondition::clamped;
  const auto body = make_body(test::setup_at(p, 0.8), test::self());
  const double pressure = 238e3;
  for (int i = 1; i <= 2000; ++i) {
    ASSERT_FALSE(body->advance(pressure, pressure).unstable) << i;
    if (i % 100 != 0) continue;
    body->observe(pressure);
    const Totals t = body->totals();
    ASSERT_NEAR((t.kinetic + t.strain) / t.external_work, 1, 0.02) << i;
  }
}

TEST(Walls, OfThreeAndOfFortySpacingsBearTheirLoad) {
  for (int across : {3, 40}) {
    Parameters p = test::small_tube("polar", false);
    const double spacing = *p.spacing;
    p.inner_radius = across * spacing / 2;
    p.outer_radius = 3 * p.inner_radius;
    p.length = 8 * spacing;
    p.ends = EndCondition::axial_periodic;
    p.layer = LayerForce::consistent;
    const auto body = make_body(test::setup_at(p, 0.8), test::self());
    // Half a breathing period or so, in which so thick a wall overshoots Lame's displacement.
    const double pressure = 1e3;
    double largest = 0;
    for (int i = 0; i < 6 * across; ++i) {
      ASSERT_FALSE(body->advance(pressure, pressure).unstable) << across;
      if (i % 5 == 4) largest = std::max(largest, body->max_displacement());
    }
    body->observe(pressure);
    const Totals t = body->totals();
    EXPECT_NEAR((t.kinetic + t.strain) / t.external_work, 1, 0.02) << across;
    const double lame = 1.25 / p.young_modulus * pressure / 8 * (0.5 + 9) * p.inner_radius;
    std::printf("%d spacings: largest displacement %.2f times Lame's\n", across, largest / lame);
    EXPECT_NEAR(largest / lame, 1.5, 0.3) << across;
  }
}

}  // namespace
}  // namespace rhexis::peridynamics
