// SPDX-License-Identifier: BSD-3-Clause
// Nothing drifts: a million steps, loose particles and fragments in free flight.
#include <gtest/gtest.h>
#include <omp.h>

#include "robustness/small_tubes.hpp"

namespace rhexis::peridynamics {
namespace {

class LongRun : public testing::TestWithParam<bool> {
 protected:
  LongRun() { omp_set_num_threads(1); }
  bool doubles() const { return GetParam(); }
};
INSTANTIATE_TEST_SUITE_P(Bonds, LongRun, testing::Values(false, true),
                         [](const auto& i) { return i.param ? "double" : "single"; });

TEST_P(LongRun, AMillionStepsKeepTheEnergy) {
  // A ring that vibrates undamped at the default time step.
  Parameters p = test::small_tube("polar", doubles());
  p.inner_radius = 1e-4;
  p.outer_radius = 2.01e-4;
  p.length = 4e-4;
  const BodySetup setup = test::setup_at(p, 0.8);
  const auto body = make_body(BodySetup(setup), test::self());
  body->set_state(test::sample(*body, test::flattened(0.002)), test::sample(*body, test::nothing));
  const auto mean = [&] {
    double sum = 0;
    for (int i = 0; i < 2000; ++i) {
      for (int k = 0; k < 8; ++k) body->advance(0, 0);
      sum += test::shadow_energy(*body, setup);
    }
    return sum / 2000;
  };
  const double start = mean();
  for (int i = 0; i < 960000; ++i) body->advance(0, 0);
  const double drift = mean() / start - 1;
  std::printf("drift over 1e6 steps: %.1e\n", drift);
  // Displacements rounded to single precision let the energy of so few particles walk at random by 1e-5.
  EXPECT_LT(std::abs(drift), doubles() ? 1e-5 : 5e-5);
}

TEST_P(LongRun, LooseParticlesFlyStraightForEver) {
  const BodySetup setup = [&] {
    Parameters p = test::small_tube("polar", doubles());
    p.critical_stretch = 1e-3;
    return test::setup_at(p, 0.8);
  }();
  const auto body = make_body(BodySetup(setup), test::self());
  // Every particle another way, by more than any bond bears.
  const auto velocity = [&](const std::array<double, 3>& x) {
    return std::array{10 * std::sin(7e4 * x[1] + 1e4 * x[2]), 10 * std::cos(5e4 * x[0]),
                      20 * std::sin(9e4 * x[2])};
  };
  const auto apart = [&](const std::array<double, 3>& x) { return std::array{x[0], x[1], x[2]}; };
  const auto v = test::sample(*body, velocity);
  const auto from = test::sample(*body, apart);
  body->set_state(from, v);
  const int steps = 50000;
  for (int i = 0; i < steps; ++i) body->advance(0, 0);
  body->observe(0);
  EXPECT_EQ(body->totals().max_damage, 1);
  EXPECT_EQ(body->totals().strain, 0);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < v[k].size(); ++i) {
      ASSERT_NEAR(body->displacement()[k][i], from[k][i] + steps * setup.time_step * v[k][i], 1e-10);
    }
  }
}

TEST_P(LongRun, FragmentsInFreeFlightKeepEnergyAndMomentum) {
  // The tube is cut half way; its halves vibrate and fly apart at 40 m/s for 50000 steps.
  Parameters p = test::small_tube("polar", doubles());
  p.critical_stretch = 0.25;
  const BodySetup setup = test::setup_at(p, 0.8);
  const auto body = make_body(BodySetup(setup), test::self());
  const double middle = p.length / 2, gap = 4e-4;
  body->set_state(test::sample(*body,
                               [&](auto x) {
                                 const auto u = test::flattened(0.02)(x);
                                 return std::array{u[0], u[1], x[2] > middle ? gap : 0.0};
                               }),
                  test::sample(*body, [&](auto x) {
                    return std::array{0.0, 0.0, x[2] > middle ? 20.0 : -20.0};
                  }));
  body->advance(0, 0);
  const ColumnLayout& l = *body->columns();
  const auto momentum = [&] {
    const Observation& seen = body->observe(0);
    std::array<double, 3> sum{};
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < seen.velocity[k].size(); ++i) {
        sum[k] += setup.density * setup.lattice.volume(i / static_cast<std::size_t>(l.row_count)) *
                  seen.velocity[k][i];
      }
    }
    return sum;
  };
  const auto vibration = [&] {
    // Kinetic energy of flight is the same for ever; strain energy over some periods stands for the rest.
    double sum = 0;
    for (int i = 0; i < 300; ++i) {
      for (int k = 0; k < 10; ++k) body->advance(0, 0);
      body->observe(0);
      sum += body->totals().strain;
    }
    return sum / 300;
  };
  const double whole = test::energy(*body), strain = vibration();
  const std::int64_t broken = body->totals().broken_bonds;
  EXPECT_GT(broken, 0);
  for (int i = 0; i < 50000; ++i) ASSERT_FALSE(body->advance(0, 0).unstable) << i;
  const double strain_later = vibration(), whole_later = test::energy(*body);
  EXPECT_EQ(body->totals().broken_bonds, broken);
  const double mass = 2 * std::numbers::pi * 1300 * (0.36e-6 - 0.09e-6) / 2 * p.length;
  for (double m : momentum()) EXPECT_NEAR(m, 0, 1e-7 * mass * 20);
  std::printf("%.2g m apart: energy off by %.1e, strain energy by %.1e\n", 2 * body->max_displacement(),
              whole_later / whole - 1, strain_later / strain - 1);
  EXPECT_NEAR(whole_later / whole, 1, 1e-3);
  EXPECT_NEAR(strain_later / strain, 1, 0.05);
}

}  // namespace
}  // namespace rhexis::peridynamics
