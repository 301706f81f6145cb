// SPDX-License-Identifier: BSD-3-Clause
// What every law must do once the engine runs it: keys, stable step, energy balance.
#include <gtest/gtest.h>

#include <numbers>

#include "core/error.hpp"
#include "peridynamics/engine/bond_kernel.hpp"
#include "peridynamics/laws/fung.hpp"
#include "peridynamics/stability/time_steps.hpp"
#include "support/vessels.hpp"

namespace rhexis::peridynamics {
namespace {

Parameters vessel_of(const std::string& law, double length = 1e-3) {
  Parameters p = test::paper_vessel(length);
  p.law.name = law;
  if (law == "fung") p.law.numbers["fung_exponent"] = 10;
  if (law == "lps") p.law.poisson_ratio = 0.4;
  return p;
}

double stable_step(Parameters p) {
  resolve(p);
  const Lattice lattice = make_lattice(p);
  return stable_time_step(make_setup(p, lattice, shared_families(p, lattice), 0));
}

std::string key_at_fault(Parameters p) {
  try {
    resolve(p);
  } catch (const InputError& e) {
    return e.key;
  }
  return "";
}

TEST(Materials, KeysOfOneLawAreErrorsWithAnother) {
  EXPECT_EQ(key_at_fault(vessel_of("fung")), "");
  Parameters p = vessel_of("fung");
  p.law.numbers.clear();
  EXPECT_EQ(key_at_fault(p), "material.fung_exponent");
  p = vessel_of("pmb");
  p.law.numbers["fung_exponent"] = 10;
  EXPECT_EQ(key_at_fault(p), "material.fung_exponent");
  p = vessel_of("fung");
  p.critical_stretch = 1.1;  // exp(12.1) before it breaks
  EXPECT_EQ(key_at_fault(p), "material.fung_exponent");
}

TEST(Materials, BondBasedLawsHaveTheirPoissonRatio) {
  EXPECT_EQ(key_at_fault(vessel_of("lps")), "");
  for (const char* law : {"pmb", "fung"}) {
    Parameters p = vessel_of(law);
    p.law.poisson_ratio = 0.4;
    EXPECT_EQ(key_at_fault(p), "material.poisson_ratio");
  }
}

TEST(Materials, StiffeningBondsTearByTheirOwnEnergy) {
  // Each bond takes c |xi| / (2 a) (exp(a s0^2) - 1): as in PMB's integral, that in place of c |xi| s0^2 / 2.
  Parameters p = vessel_of("fung");
  p.critical_stretch.reset();
  p.energy_release_rate = 300;
  resolve(p);
  const double a = p.law.number("fung_exponent"), s0 = *p.critical_stretch;
  const double c = Pmb::bond_constant(p.young_modulus, *p.horizon);
  EXPECT_GT(a * s0 * s0, 0.5) << "too little stiffening to mean anything";
  EXPECT_NEAR(c * std::numbers::pi * std::pow(*p.horizon, 5) / 10 * std::expm1(a * s0 * s0) / a, 300, 1e-9);
  EXPECT_NEAR(Fung{a}.energy_release_rate(p.young_modulus, *p.horizon, s0), 300, 1e-9);
}

TEST(Materials, EnergyReleaseRateIsOfBondBasedLaws) {
  Parameters p = vessel_of("lps");
  p.critical_stretch.reset();
  p.energy_release_rate = 90;
  EXPECT_EQ(key_at_fault(p), "material.energy_release_rate");
  p.law = {.name = "fung"};
  EXPECT_EQ(key_at_fault(p), "material.fung_exponent");
}

TEST(Materials, StiffeningBondsNeedAShorterStep) {
  // At s0 = 0.25 and a = 8 a bond is 2 exp(1/2) times as stiff as a linear one.
  Parameters p = vessel_of("fung");
  p.law.numbers["fung_exponent"] = 8;
  EXPECT_NEAR(stable_step(vessel_of("pmb")) / stable_step(p), std::sqrt(2 * std::exp(0.5)), 1e-12);
}

class EachLaw : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Materials, EachLaw, testing::Values("pmb", "fung", "lps"),
                         [](const auto& i) { return std::string(i.param); });

TEST_P(EachLaw, ActionIsReaction) {
  Parameters p = vessel_of(GetParam());
  p.cross_section = Arrangement::polar;  // unequal volumes
  p.bond_precision = Precision::double_precision;
  p.ends = EndCondition::free;
  p.critical_stretch = 0.05;
  const BodySetup setup = test::setup_of(p, 1e-7);
  const auto body = make_body(BodySetup(setup), test::self());
  body->set_state(test::sample(*body, test::wild(setup.lattice.spacing)), test::sample(*body, test::nothing));
  const Observation& seen = body->observe(0);
  EXPECT_GT(body->totals().broken_bonds, 0);
  const ColumnLayout& l = *body->columns();
  double sum[3] = {}, size = 0;
  for (std::int64_t i = 0; i < l.local_count(); ++i) {
    const double volume = setup.lattice.volume(static_cast<std::size_t>(i / l.row_count));
    for (std::size_t k = 0; k < 3; ++k) {
      const double force = volume * seen.force_density[k][static_cast<std::size_t>(i)];
      sum[k] += force;
      size += std::abs(force);
    }
  }
  for (double s : sum) EXPECT_NEAR(s, 0, 1e-13 * size);
}

TEST_P(EachLaw, PiecesPullAsTheyDoHoweverFarApart) {
  Parameters p = vessel_of(GetParam());
  p.bond_precision = Precision::double_precision;
  p.ends = EndCondition::free;
  const BodySetup setup = test::setup_of(p, 1e-7);
  const double h = setup.lattice.spacing;
  const auto forces = [&](double away, bool wrapped) {
    const auto body = make_body(BodySetup(setup), test::self());
    body->set_state(test::sample(*body,
                                 [&](auto x) {
                                   const double side = x[2] > p.length / 2 ? 1 : -1;
                                   return std::array{50 * h * side + 0.1 * h * std::sin(5e3 * x[1]),
                                                     0.1 * h * std::sin(5e3 * x[2]),
                                                     away * side + 0.1 * h * std::sin(5e3 * x[0])};
                                 }),
                    test::sample(*body, test::nothing));
    EXPECT_EQ(body->save().wrapped, wrapped);
    return body->observe(0).force_density;
  };
  // Far apart, each piece lies across the end of a period; they are apart in x too, lest whole periods hide
  // it.
  const auto near = forces(50 * h, false), far = forces(4.5 * wrap_period * h, true);
  double largest = 0, difference = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < near[k].size(); ++i) {
      largest = std::max(largest, std::abs(near[k][i]));
      difference = std::max(difference, std::abs(far[k][i] - near[k][i]));
    }
  }
  EXPECT_GT(largest, 0);
  EXPECT_LT(difference, 1e-9 * largest);
}

TEST_P(EachLaw, RestoredBodyGoesOnBitByBit) {
  Parameters p = vessel_of(GetParam());
  p.critical_stretch = 0.05;
  const BodySetup setup = test::setup_of(p, 0.5 * stable_step(p));
  const auto run = [](Body& body, int from, int to) {
    for (int i = from; i < to; ++i) body.advance(300e3, 300e3);
    return body.observe(300e3).force_density;
  };
  const auto straight = make_body(BodySetup(setup), test::self());
  run(*straight, 0, 60);
  const auto resumed = make_body(BodySetup(setup), test::self());
  resumed->restore(straight->save());
  EXPECT_EQ(run(*straight, 60, 100), run(*resumed, 60, 100));
  EXPECT_GT(straight->totals().broken_bonds, 1000);
  EXPECT_NEAR(resumed->totals().fracture / straight->totals().fracture, 1, 1e-14);
}

TEST_P(EachLaw, EnergyBalancesThroughRupture) {
  Parameters p = vessel_of(GetParam());
  p.critical_stretch = 0.1;
  p.ends = EndCondition::free;
  BodySetup setup = test::setup_of(p, 0.1 * stable_step(p));
  const auto body = make_body(std::move(setup), test::self());
  Totals t;
  for (int i = 0; t.broken_bonds < 3000 && i < 600; ++i) {
    body->advance(1500.0 * i, 1500.0 * (i + 1));
    if (i % 10 == 9) {
      body->observe(1500.0 * (i + 1));
      t = body->totals();
    }
  }
  ASSERT_GT(t.broken_bonds, 3000);
  EXPECT_GT(t.fracture, 0.01 * t.external_work);
  std::printf("%s: %ld bonds broken, kinetic %.3g, strain %.3g, fracture %.3g of the work, off by %.2g\n",
              GetParam(), static_cast<long>(t.broken_bonds), t.kinetic / t.external_work,
              t.strain / t.external_work, t.fracture / t.external_work,
              (t.kinetic + t.strain + t.fracture) / t.external_work - 1);
  EXPECT_NEAR((t.kinetic + t.strain + t.fracture) / t.external_work, 1, 3e-4);
}

}  // namespace
}  // namespace rhexis::peridynamics
