// SPDX-License-Identifier: BSD-3-Clause
// How long a time step may be: the computed stable one, where instability really begins, and that it is
// noticed.
#include <gtest/gtest.h>

#include "peridynamics/stability/linear_limit.hpp"
#include "robustness/small_tubes.hpp"

namespace rhexis::peridynamics {
namespace {

struct Kind {
  const char* cross_section;
  const char* ends;
  double critical_stretch;  ///< which the stable step allows for
};

void PrintTo(const Kind& k, std::ostream* out) {
  *out << k.cross_section << ' ' << k.ends << ' ' << k.critical_stretch;
}

class TimeStep : public testing::TestWithParam<Kind> {
 protected:
  Parameters tube() const {
    Parameters p = test::small_tube(GetParam().cross_section, false);
    p.ends = value_of<EndCondition>(GetParam().ends).value();
    p.critical_stretch = GetParam().critical_stretch;
    return p;
  }
};
INSTANTIATE_TEST_SUITE_P(Tubes, TimeStep,
                         testing::Values(Kind{"lattice", "free", 10}, Kind{"polar", "free", 0.25},
                                         Kind{"lattice", "axial_periodic", 0.25},
                                         Kind{"polar", "sliding", 10}));

TEST_P(TimeStep, JustBelowTheStableOneIsStable) {
  const auto body = make_body(test::setup_at(tube(), 0.95), test::self());
  body->set_state(test::sample(*body, test::flattened(0.02)), test::sample(*body, test::nothing));
  const double start = test::energy(*body);
  for (int i = 1; i <= 20000; ++i) {
    ASSERT_FALSE(body->advance(0, 0).unstable) << i;
    // Energy at whole steps is below a constant by (omega dt)^2/4 of what each mode has.
    if (i % 500 != 0) continue;
    ASSERT_NEAR(test::energy(*body) / start, 1, 0.1) << i;
  }
}

TEST_P(TimeStep, InstabilityBeginsAtTheLinearLimit) {
  // 1.9 to 2.1 times the computed step of bonds that hold for ever, a bound for all directions at once and
  // for neighbours that all move against each other; 1.2 to 1.4 times that of bonds that break at 0.25.
  const double ratio =
      linear_time_step_limit(test::setup_at(tube(), 1)) / test::stable_step_of(test::setup_at(tube(), 1));
  std::printf("%s %s: limit %.4f times the stable step\n", GetParam().cross_section, GetParam().ends, ratio);
  EXPECT_GT(ratio, 1.1);
  EXPECT_LT(ratio, GetParam().critical_stretch > 1 ? 2.5 : 1.5);
  const auto growth = [&](double share) {
    const auto body = make_body(test::setup_at(tube(), share), test::self());
    body->set_state(test::sample(*body,
                                 [](auto x) {
                                   return std::array{1e-9 * std::sin(7e4 * x[1]), 1e-9 * std::sin(5e4 * x[2]),
                                                     1e-9 * std::sin(9e4 * x[0])};
                                 }),
                    test::sample(*body, test::nothing));
    const double start = test::energy(*body);
    for (int i = 0; i < 1500; ++i) body->advance(0, 0);
    return test::energy(*body) / start;
  };
  EXPECT_LT(growth(0.995 * ratio), 10);
  // Held ends take the highest modes away from a short tube.
  EXPECT_GT(growth((std::string(GetParam().ends) == "axial_periodic" ? 1.005 : 1.05) * ratio), 1e6);
}

TEST_P(TimeStep, BlowUpIsNoticedWithinAFewSteps) {
  // Where bonds break they keep particles slow: that a wall has been torn by its time step is for the balance
  // of energy to tell (test_hard_runs.py).
  const auto body = make_body(test::setup_at(tube(), 2.5), test::self());
  body->set_state(test::sample(*body, test::flattened(0.02)), test::sample(*body, test::nothing));
  int steps = 1;
  while (!body->advance(0, 0).unstable && steps < 100) ++steps;
  std::printf("noticed after %d steps\n", steps);
  EXPECT_LE(steps, 15);
}

}  // namespace
}  // namespace rhexis::peridynamics
