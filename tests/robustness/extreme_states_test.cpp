// SPDX-License-Identifier: BSD-3-Clause
// States far from rest: crushed, coincident, far away, spinning, torn apart.
#include <gtest/gtest.h>

#include "robustness/small_tubes.hpp"

namespace rhexis::peridynamics {
namespace {

using State = std::array<std::vector<double>, 3>;

class Extreme : public testing::TestWithParam<bool> {
 protected:
  bool doubles() const { return GetParam(); }
  Parameters tube() const { return test::small_tube("polar", doubles()); }
};
INSTANTIATE_TEST_SUITE_P(Bonds, Extreme, testing::Values(false, true),
                         [](const auto& i) { return i.param ? "double" : "single"; });

TEST_P(Extreme, ForceOfCoincidentParticlesIsNeverAboveTheOneAtFullCompression) {
  const auto body = make_body(test::two_particles(doubles(), 10, 1e-2), test::self());
  for (double distance : {0.0, 1e-9, 1e-7, 1e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 1e-2, 0.1}) {
    body->set_state(State{{{0.0, distance - 1}, {0.0, 0.0}, {0.0, 0.0}}},
                    State{{{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}}});
    const double force = body->observe(0).force_density[0][1];
    EXPECT_TRUE(std::isfinite(body->totals().strain));
    // f = c s away from the other: 1 - distance; below a thousandth of the bond less, but not backwards.
    EXPECT_GE(force, 0) << distance;
    EXPECT_LE(force, 1.05) << distance;
    if (distance < 1.5e-3) continue;
    EXPECT_NEAR(force, 1 - distance, 0.05) << distance;
  }
}

TEST_P(Extreme, PairThatPassesThroughItselfKeepsItsEnergy) {
  const auto body = make_body(test::two_particles(doubles(), 10, 1e-2), test::self());
  // Fast enough towards each other to pass, not head on.
  body->set_state(State{{{0.0, 0.0}, {0.0, 1e-3}, {0.0, 0.0}}}, State{{{1.0, -1.0}, {0.0, 0.0}, {0.0, 0.0}}});
  const double start = test::energy(*body);
  for (int i = 0; i < 1000; ++i) body->advance(0, 0);
  EXPECT_NEAR(test::energy(*body) / start, 1, 0.02);
}

/// The tube of bonds that never break, its lengths times 1 + `stretch`, let go; largest change of its energy.
double worst_energy(const Parameters& p, double stretch, double share_of_stable_step, int steps) {
  const auto body = make_body(test::setup_at(p, share_of_stable_step), test::self());
  body->set_state(test::sample(*body,
                               [&](auto x) {
                                 return std::array{stretch * x[0], stretch * x[1], stretch * x[2]};
                               }),
                  test::sample(*body, test::nothing));
  test::allow_speed(*body, 100 * std::max(1.0, stretch));
  const double start = test::energy(*body);
  EXPECT_EQ(body->totals().crushed_bonds > 0, stretch < -0.5);
  double worst = 0;
  for (int i = 1; i <= steps; ++i) {
    if (body->advance(0, 0).unstable) {
      ADD_FAILURE() << "a false alarm at " << i;
      break;
    }
    if (i % 20 == 0) worst = std::max(worst, std::abs(test::energy(*body) / start - 1));
  }
  std::printf("stretched by %g %%, %g of the stable step: energy within %.1e over %d steps\n", 100 * stretch,
              share_of_stable_step, worst, steps);
  return worst;
}

TEST_P(Extreme, CrushedTubeSpringsBackWithoutBlowingUp) {
  // A PMB bond stores no more than c |xi| / 2, however short it gets: crushing cannot blow up. But bonds that
  // turn over within a step make energy slowly; a shorter step resolves them.
  for (double stretch : {-0.3, -0.6, -0.9}) {
    EXPECT_LT(worst_energy(tube(), stretch, 0.8, 100), 0.15);
    EXPECT_LT(worst_energy(tube(), stretch, 0.1, 800), 0.02);
  }
}

TEST(Balance, CrushedBondsLeaveLessRoomForEnergyOutOfNowhere) {
  Totals t;
  t.kinetic = 1.05;
  t.external_work = 1;
  t.crushed_bonds = 1;
  EXPECT_TRUE(holds_no_more_than_was_put_in(t));
  t.kinetic = 1.5;
  EXPECT_FALSE(holds_no_more_than_was_put_in(t));
  t.crushed_bonds = 0;
  EXPECT_TRUE(holds_no_more_than_was_put_in(t));
  t.kinetic = 2.5;
  EXPECT_FALSE(holds_no_more_than_was_put_in(t));
}

TEST_P(Extreme, StronglyStretchedTubeSpringsBackToo) {
  // Across a bond the stiffness grows to c/|xi| as s grows, which the stable step is made for.
  EXPECT_LT(worst_energy(tube(), 3, 0.95, 100), 0.15);
  EXPECT_LT(worst_energy(tube(), 3, 0.1, 800), 0.02);
}

TEST_P(Extreme, MotionDoesNotKnowHowFarAwayItIs) {
  const auto after = [&](std::array<double, 3> away) {
    const auto body = make_body(test::setup_at(tube(), 0.8), test::self());
    body->set_state(test::sample(*body,
                                 [&](auto x) {
                                   const auto u = test::flattened(0.02)(x);
                                   return std::array{u[0] + away[0], u[1] + away[1], u[2] + away[2]};
                                 }),
                    test::sample(*body, test::nothing));
    for (int i = 0; i < 300; ++i) body->advance(0, 0);
    const auto moved = body->displacement();
    State u;
    for (std::size_t k = 0; k < 3; ++k) {
      for (double x : moved[k]) u[k].push_back(x - away[k]);
    }
    return u;
  };
  const State here = after({0, 0, 0}), there = after({1, -1, 1});
  double largest = 0, difference = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < here[k].size(); ++i) {
      largest = std::max(largest, std::abs(here[k][i]));
      difference = std::max(difference, std::abs(here[k][i] - there[k][i]));
    }
  }
  std::printf("a metre away: %.1e of the largest displacement\n", difference / largest);
  EXPECT_LT(difference, 1e-5 * largest);
}

TEST_P(Extreme, FragmentsFarApartGoOnFromARestartBitByBit) {
  // Halves a thousand spacings apart, beyond what one frame serves in single precision.
  Parameters p = tube();
  p.critical_stretch = 0.25;
  const BodySetup setup = test::setup_at(p, 0.8);
  const auto straight = make_body(BodySetup(setup), test::self());
  straight->set_state(test::sample(*straight,
                                   [&](auto x) {
                                     const auto u = test::flattened(0.02)(x);
                                     return std::array{u[0], u[1], x[2] > p.length / 2 ? 0.2 : 0.0};
                                   }),
                      test::sample(*straight, test::nothing));
  for (int i = 0; i < 100; ++i) straight->advance(0, 0);
  const Body::Saved saved = straight->save();
  EXPECT_TRUE(saved.wrapped);
  const auto restarted = make_body(BodySetup(setup), test::self());
  restarted->restore(saved);
  for (int i = 0; i < 100; ++i) {
    straight->advance(0, 0);
    restarted->advance(0, 0);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const auto a = straight->displacement()[k], b = restarted->displacement()[k];
    ASSERT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
  }
}

struct Spun {
  std::vector<double> radius;  ///< of every particle from the axis, in the end, m
  double angular_momentum_error = 0, energy_error = 0;
};

/// 1e4 rad/s for ten turns: 6 m/s at the outer surface, hoop strains of 1 %.
Spun spin(const Parameters& p) {
  const double rate = 1e4;
  const BodySetup setup = test::setup_at(p, 0.8);
  const auto body = make_body(BodySetup(setup), test::self());
  body->set_state(test::sample(*body, test::nothing), test::sample(*body, [&](auto x) {
                    return std::array{-rate * x[1], rate * x[0], 0.0};
                  }));
  Spun spun;
  const ColumnLayout& l = *body->columns();
  const auto angular_momentum = [&] {
    const Observation& seen = body->observe(0);
    const auto u = body->displacement();
    spun.radius.clear();
    double sum = 0;
    std::size_t i = 0;
    for (std::int64_t c = 0; c < l.column_count; ++c) {
      for (std::int64_t r = 0; r < l.row_count; ++r, ++i) {
        const auto x = body->reference_position(l.particle(c, r));
        const double here[2] = {x[0] + u[0][i], x[1] + u[1][i]};
        spun.radius.push_back(std::hypot(here[0], here[1]));
        sum += setup.lattice.volume(static_cast<std::size_t>(c)) *
               (here[0] * seen.velocity[1][i] - here[1] * seen.velocity[0][i]);
      }
    }
    return sum;
  };
  const double momentum = angular_momentum(), energy = test::energy(*body);
  const int steps = static_cast<int>(10 * 2 * std::numbers::pi / rate / setup.time_step);
  for (int i = 0; i < steps; ++i) body->advance(0, 0);
  spun.angular_momentum_error = angular_momentum() / momentum - 1;
  spun.energy_error = test::energy(*body) / energy - 1;
  return spun;
}

TEST(Spinning, LosesNothingInSinglePrecision) {
  const Spun with_double = spin(test::small_tube("polar", true)),
             with_single = spin(test::small_tube("polar", false));
  EXPECT_LT(std::abs(with_double.angular_momentum_error), 1e-12);
  EXPECT_LT(std::abs(with_single.angular_momentum_error), 1e-7);
  EXPECT_LT(std::abs(with_double.energy_error), 2e-5);
  EXPECT_LT(std::abs(with_single.energy_error), 2e-5);
  double difference = 0;
  for (std::size_t i = 0; i < with_double.radius.size(); ++i)
    difference = std::max(difference, std::abs(with_single.radius[i] - with_double.radius[i]));
  std::printf("angular momentum off by %.1e, energy by %.1e; radii differ from double by %.1e of a spacing\n",
              with_single.angular_momentum_error, with_single.energy_error, difference / 1e-4);
  EXPECT_LT(difference, 1e-4 * 1e-4);
}

}  // namespace
}  // namespace rhexis::peridynamics
