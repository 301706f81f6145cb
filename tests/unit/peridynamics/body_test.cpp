// SPDX-License-Identifier: BSD-3-Clause
// The engine on bodies small enough for closed forms.
#include "peridynamics/engine/body.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/vessels.hpp"

namespace rhexis::peridynamics {
namespace {

class InPrecision : public testing::TestWithParam<bool> {
 protected:
  bool doubles() const { return GetParam(); }
};
INSTANTIATE_TEST_SUITE_P(Bonds, InPrecision, testing::Values(false, true),
                         [](const auto& i) { return i.param ? "double" : "single"; });

using State = std::array<std::vector<double>, 3>;

TEST_P(InPrecision, PairBreaksAtTheCriticalStretchAtBothEndsAtOnce) {
  const double margin = doubles() ? 1e-14 : 2e-7;
  for (double away : {-margin, margin}) {
    const auto body = make_body(test::two_particles(doubles(), 0.25, 1e-3), test::self());
    body->set_state(State{{{0.0, 0.25 + away}, {0.0, 0.0}, {0.0, 0.0}}},
                    State{{{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}}});
    const Observation& seen = body->observe(0);
    const bool breaks = away > 0;
    EXPECT_EQ(seen.damage[0], breaks ? 1 : 0);
    EXPECT_EQ(seen.damage[1], breaks ? 1 : 0);
    EXPECT_EQ(body->totals().broken_bonds, breaks ? 1 : 0);
    // Eq. (2): f = c s towards the other, and nothing once broken.
    EXPECT_NEAR(seen.force_density[0][0], breaks ? 0 : 0.25, 1e-6);
    EXPECT_EQ(seen.force_density[0][0], -seen.force_density[0][1]);
    EXPECT_EQ(body->advance(0, 0).broken, breaks ? 2 : 0);
  }
}

TEST_P(InPrecision, PairOscillatesAtItsFrequencyToSecondOrder) {
  // Relative motion of the pair: r'' = -2 c s, so s = s0 cos(sqrt(2) t) along the bond.
  const auto error = [&](double dt) {
    const auto body = make_body(test::two_particles(doubles(), 0.25, dt), test::self());
    const double amplitude = 0.1, end = 4;
    body->set_state(State{{{-amplitude / 2, amplitude / 2}, {0, 0}, {0, 0}}},
                    State{{{0, 0}, {0, 0}, {0, 0}}});
    const int steps = static_cast<int>(std::lround(end / dt));
    for (int i = 0; i < steps; ++i) body->advance(0, 0);
    const auto u = body->displacement()[0];
    return std::abs((u[1] - u[0]) - amplitude * std::cos(std::sqrt(2.0) * end));
  };
  const double coarse = error(0.04), fine = error(0.02);
  EXPECT_NEAR(coarse / fine, 4, 0.1);
}

TEST_P(InPrecision, RigidMotionsMakeNoForce) {
  Parameters p = test::paper_vessel(1e-3);
  p.bond_precision = doubles() ? Precision::double_precision : Precision::single_precision;
  p.ends = EndCondition::free;
  const BodySetup setup = test::setup_of(p, 1e-7);
  // A bond stretched by one per cent has this force density on one particle.
  const double scale = setup.bond_constant * 0.01 * std::pow(setup.lattice.spacing, 3);
  const double spacing = setup.lattice.spacing;
  const auto largest_force = [&](auto displacement) {
    const auto body = make_body(BodySetup(setup), test::self());
    body->set_state(test::sample(*body, displacement), test::sample(*body, test::nothing));
    const Observation& seen = body->observe(0);
    double largest = 0;
    for (int k = 0; k < 3; ++k) {
      for (double f : seen.force_density[k]) largest = std::max(largest, std::abs(f));
    }
    EXPECT_EQ(body->totals().broken_bonds, 0);
    return largest / scale;
  };
  const auto rotation = [](double angle, double tilt) {
    return [=](std::array<double, 3> x) {
      // About z by `angle`, then about x by `tilt`.
      const double a = x[0] * std::cos(angle) - x[1] * std::sin(angle);
      const double b = x[0] * std::sin(angle) + x[1] * std::cos(angle);
      return std::array{a - x[0], b * std::cos(tilt) - x[2] * std::sin(tilt) - x[1],
                        b * std::sin(tilt) + x[2] * std::cos(tilt) - x[2]};
    };
  };
  // Round-off of coordinates of some spacings, in units of a one-per-cent stretch.
  const double tolerance = doubles() ? 1e-10 : 1e-2;
  EXPECT_LT(largest_force([&](auto) {
              return std::array{0.37 * spacing, -0.21 * spacing, 0.11 * spacing};
            }),
            doubles() ? 1e-10 : 1e-3);
  EXPECT_LT(largest_force([](auto) {
              return std::array{1.0, -2.0, 3.0};
            }),
            doubles() ? 1e-6 : 1e-3)
      << "metres away: only the rounding of the double positions is left";
  EXPECT_LT(largest_force(rotation(0.3, 0.2)), tolerance);
  EXPECT_LT(largest_force(rotation(2.5, 1.5)), tolerance);
}

TEST_P(InPrecision, MomentumIsConserved) {
  Parameters p = test::paper_vessel(1e-3);
  p.cross_section = Arrangement::polar;  // unequal volumes
  p.bond_precision = doubles() ? Precision::double_precision : Precision::single_precision;
  p.ends = EndCondition::free;
  p.critical_stretch = 0.05;
  const BodySetup setup = test::setup_of(p, 1e-7);
  const auto body = make_body(BodySetup(setup), test::self());
  body->set_state(test::sample(*body, test::wild(setup.lattice.spacing)), test::sample(*body, test::nothing));
  const Observation& seen = body->observe(0);
  EXPECT_GT(body->totals().broken_bonds, 0);
  const ColumnLayout& l = *body->columns();
  double sum[3] = {}, size = 0, moment = 0;
  std::size_t i = 0;
  const auto u = body->displacement();
  for (std::int64_t c = 0; c < l.column_count; ++c) {
    const double volume = setup.lattice.volume(static_cast<std::size_t>(c));
    for (std::int64_t r = 0; r < l.row_count; ++r, ++i) {
      const auto x = body->reference_position(l.particle(c, r));
      for (std::size_t k = 0; k < 3; ++k) sum[k] += volume * seen.force_density[k][i];
      size += volume * std::abs(seen.force_density[0][i]);
      moment += volume *
                ((x[0] + u[0][i]) * seen.force_density[1][i] - (x[1] + u[1][i]) * seen.force_density[0][i]);
    }
  }
  const double tolerance = (doubles() ? 1e-13 : 1e-6) * size;
  for (double s : sum) EXPECT_NEAR(s, 0, tolerance);
  EXPECT_NEAR(moment, 0, tolerance * 2e-3);
}

TEST_P(InPrecision, EnergyIsConservedWhileItVibrates) {
  Parameters p = test::paper_vessel(5e-4);
  p.bond_precision = doubles() ? Precision::double_precision : Precision::single_precision;
  p.ends = EndCondition::free;
  BodySetup setup = test::setup_of(p, 1e-7);
  setup.time_step = 0.03 * test::stable_step_of(setup);
  const auto body = make_body(std::move(setup), test::self());
  body->set_state(test::sample(*body,
                               [](auto x) {
                                 return std::array{0.01 * x[0], -0.01 * x[1], 0.0};
                               }),
                  test::sample(*body, test::nothing));
  body->observe(0);
  const double start = body->totals().strain;
  EXPECT_GT(start, 0);
  for (int i = 0; i < 400; ++i) body->advance(0, 0);
  body->observe(0);
  const Totals end = body->totals();
  EXPECT_GT(end.kinetic, 0.01 * start);
  EXPECT_NEAR((end.kinetic + end.strain) / start, 1, 1e-4);
}

TEST_P(InPrecision, WorkOfThePressureBecomesEnergy) {
  Parameters p = test::paper_vessel(1e-3);
  p.bond_precision = doubles() ? Precision::double_precision : Precision::single_precision;
  BodySetup setup = test::setup_of(p, 1e-7);
  setup.time_step = 0.03 * test::stable_step_of(setup);
  const auto body = make_body(std::move(setup), test::self());
  for (int i = 0; i < 500; ++i) body->advance(100.0 * i, 100.0 * (i + 1));
  body->observe(100.0 * 500);
  const Totals t = body->totals();
  EXPECT_GT(t.external_work, 0);
  EXPECT_NEAR((t.kinetic + t.strain) / t.external_work, 1, 1e-4);
}

TEST_P(InPrecision, UniformStrainHasTheContinuumEnergy) {
  // Bulk particles under a volume strain e store 9 K e^2 / 2 (Silling & Askari); the sum over a family of 178
  // is close to the integral.
  Parameters p = test::paper_vessel(2e-3);
  p.inner_radius = 1e-6;
  p.bond_precision = doubles() ? Precision::double_precision : Precision::single_precision;
  p.ends = EndCondition::free;
  const auto body = make_body(test::setup_of(p, 1e-7), test::self());
  const double e = 1e-3;
  body->set_state(test::sample(*body,
                               [&](auto x) {
                                 return std::array{e * x[0], e * x[1], e * x[2]};
                               }),
                  test::sample(*body, test::nothing));
  const Observation& seen = body->observe(0);
  const double bulk = p.young_modulus / (3 * (1 - 2 * 0.25));
  double largest = 0;
  for (double w : seen.strain_energy_density) largest = std::max(largest, w);
  EXPECT_NEAR(largest / (4.5 * bulk * e * e), 1, 0.05);
}

TEST_P(InPrecision, HalvedBodyHasTheDamageOfItsCut) {
  // Pull the halves above and below a plane apart: damage of a particle is the share of its family beyond.
  Parameters p = test::paper_vessel(2e-3);
  p.bond_precision = doubles() ? Precision::double_precision : Precision::single_precision;
  p.ends = EndCondition::free;
  const BodySetup setup = test::setup_of(p, 1e-7);
  const auto body = make_body(BodySetup(setup), test::self());
  body->set_state(test::sample(*body,
                               [](auto x) {
                                 return std::array{0.0, 0.0, x[2] > 1e-3 ? 1e-3 : 0.0};
                               }),
                  test::sample(*body, test::nothing));
  const Observation& seen = body->observe(0);
  const ColumnLayout& l = *body->columns();
  std::int64_t cut = 0;
  for (std::int64_t c = 0; c < l.columns; ++c) {
    for (std::int64_t r = 0; r < l.rows; ++r) {
      double whole = 0, beyond = 0;
      for (std::int64_t b = setup.families->first[c]; b < setup.families->first[c + 1]; ++b) {
        const std::int64_t other = r + setup.families->bonds[b].row_offset;
        if (other < 0 || other >= l.rows) continue;
        whole += 1;
        if ((other >= 10) != (r >= 10)) beyond += 1;
      }
      cut += static_cast<std::int64_t>(beyond);
      ASSERT_NEAR(seen.damage[c * l.rows + r], beyond / whole, 1e-12) << c << ' ' << r;
    }
  }
  const Totals t = body->totals();
  EXPECT_EQ(t.broken_bonds, cut / 2);
  EXPECT_GT(t.fracture, 0);
}

TEST(Body, HeldEndsStayAndSlidingEndsSlide) {
  for (const char* ends : {"clamped", "sliding", "free"}) {
    Parameters p = test::paper_vessel(2e-3);
    p.ends = value_of<EndCondition>(ends).value();
    const auto body = make_body(test::setup_of(p, 5e-7), test::self());
    for (int i = 0; i < 100; ++i) body->advance(20e3, 20e3);
    const auto u = body->displacement();
    const std::int64_t rows = body->columns()->rows;
    double held_radial = 0, held_axial = 0, middle = 0;
    for (std::int64_t c = 0; c < body->columns()->columns; ++c) {
      for (std::int64_t r : {std::int64_t{0}, std::int64_t{3}, rows - 4, rows - 1}) {
        held_radial = std::max(held_radial, std::hypot(u[0][c * rows + r], u[1][c * rows + r]));
        held_axial = std::max(held_axial, std::abs(u[2][c * rows + r]));
      }
      middle = std::max(middle, std::hypot(u[0][c * rows + rows / 2], u[1][c * rows + rows / 2]));
    }
    EXPECT_GT(middle, 0);
    EXPECT_EQ(held_radial > 0, std::string(ends) != "clamped") << ends;
    EXPECT_EQ(held_axial > 0, std::string(ends) == "free") << ends;
  }
}

TEST(Body, TooLargeAStepIsNoticed) {
  Parameters p = test::paper_vessel(1e-3);
  p.ends = EndCondition::free;
  BodySetup setup = test::setup_of(p, 1e-7);
  setup.time_step = 4 * test::stable_step_of(setup);
  const auto body = make_body(std::move(setup), test::self());
  bool unstable = false;
  for (int i = 0; i < 300 && !unstable; ++i) unstable = body->advance(100, 100).unstable;
  EXPECT_TRUE(unstable);
}

TEST(Body, PeriodicVesselDoesNotKnowWhereItIsCut) {
  Parameters p = test::paper_vessel(2e-3);
  p.ends = EndCondition::axial_periodic;
  const auto body = make_body(test::setup_of(p, 5e-7), test::self());
  for (int i = 0; i < 50; ++i) body->advance(20e3, 20e3);
  const auto u = body->displacement();
  const std::int64_t rows = body->columns()->rows;
  for (std::int64_t c = 0; c < body->columns()->columns; ++c) {
    for (std::int64_t r = 1; r < rows; ++r) ASSERT_EQ(u[0][c * rows + r], u[0][c * rows]);
  }
}

TEST(Body, ObservingChangesNothing) {
  for (const char* law : {"pmb", "lps"}) {
    Parameters p = test::paper_vessel(1e-3);
    p.ends = EndCondition::free;
    p.critical_stretch = 0.05;
    p.law.name = law;
    const BodySetup setup = test::setup_of(p, 1e-7);
    const auto end = [&](bool observing) {
      const auto body = make_body(BodySetup(setup), test::self());
      body->set_state(test::sample(*body, test::wild(setup.lattice.spacing)), test::sample(*body, [](auto) {
                        return std::array{90.0, -60.0, 30.0};
                      }));
      std::int64_t told = 0;
      for (int i = 0; i < 70; ++i) {  // past the 64 steps after which the frame follows the body
        if (observing && (i % 3 == 0 || i == 64)) body->observe(1e3);
        told += body->advance(1e3, 1e3).broken;
      }
      return std::pair(body->save(), told);
    };
    const auto [observed, told] = end(true);
    const auto [unobserved, expected] = end(false);
    EXPECT_EQ(observed.displacement, unobserved.displacement);
    EXPECT_EQ(observed.leapfrog_velocity, unobserved.leapfrog_velocity);
    EXPECT_EQ(observed.words, unobserved.words);
    EXPECT_EQ(observed.external_work, unobserved.external_work);
    EXPECT_EQ(observed.released_energy, unobserved.released_energy);
    EXPECT_EQ(told, expected);
    EXPECT_GT(told, 0);
  }
}

TEST(Body, RestoredBodyGoesOnBitByBit) {
  // In flight, so that the frame of the single-precision copy must follow it.
  Parameters p = test::paper_vessel(1e-3);
  p.ends = EndCondition::free;
  p.critical_stretch = 0.05;
  const BodySetup setup = test::setup_of(p, 5e-7);
  const auto run = [](Body& body, int from, int to) {
    for (int i = from; i < to; ++i) body.advance(120e3, 120e3);
  };
  const auto straight = make_body(BodySetup(setup), test::self());
  const auto launch = [](Body& body) {
    body.set_state(test::sample(body, test::nothing), test::sample(body, [](auto) {
                     return std::array{30.0, -20.0, 10.0};
                   }));
  };
  launch(*straight);
  run(*straight, 0, 500);
  const auto first = make_body(BodySetup(setup), test::self());
  launch(*first);
  run(*first, 0, 300);  // not a multiple of 64, the frame's interval
  const auto second = make_body(BodySetup(setup), test::self());
  const Body::Saved saved = first->save();
  EXPECT_NE(saved.frame, (std::array<double, 3>{}))
      << "the frame must have moved for this test to mean anything";
  second->restore(saved);
  run(*second, 300, 500);
  for (int k = 0; k < 3; ++k) {
    const auto a = straight->displacement()[k], b = second->displacement()[k];
    ASSERT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
  }
  straight->observe(0);
  second->observe(0);
  EXPECT_GT(straight->totals().broken_bonds, 0);
  EXPECT_EQ(straight->totals().broken_bonds, second->totals().broken_bonds);
  EXPECT_EQ(straight->totals().external_work, second->totals().external_work);
}

}  // namespace
}  // namespace rhexis::peridynamics
