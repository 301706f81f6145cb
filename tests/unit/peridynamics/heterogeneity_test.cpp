// SPDX-License-Identifier: BSD-3-Clause
// Walls whose properties differ from place to place, against sums over bonds that are done here once more.
#include "peridynamics/geometry/heterogeneity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "peridynamics/stability/time_steps.hpp"
#include "support/vessels.hpp"

namespace rhexis::peridynamics {
namespace {

Parameters scattered(double critical_stretch, double stiffness, ScatterLaw law = ScatterLaw::lognormal) {
  Parameters p = test::paper_vessel(2e-3);
  p.ends = EndCondition::free;
  p.bond_precision = Precision::double_precision;
  p.step_fraction = 0.65;
  p.scatter = {.law = law, .critical_stretch = critical_stretch, .stiffness = stiffness};
  return p;
}

LocalFactors factors_at(const Heterogeneity& wall, const std::array<double, 3>& x) {
  const double z[] = {x[2]};
  return wall.along(x[0], x[1], z).front();
}

TEST(Heterogeneity, FactorsHaveMeanOneAndTheirSpreads) {
  constexpr int seeds = 20000;
  for (const auto law : {ScatterLaw::lognormal, ScatterLaw::weibull}) {
    Parameters p = scattered(0.1, 0.3, law);
    resolve(p);
    std::array<double, 2> mean{}, square{};
    for (int s = 0; s < seeds; ++s) {
      p.scatter.seed = s;
      const LocalFactors f = factors_at(Heterogeneity(p), {1.6e-3, 2e-4, 5e-4});
      const std::array both{f.critical_stretch, f.stiffness};
      for (std::size_t k = 0; k < 2; ++k) {
        mean[k] += both[k] / seeds;
        square[k] += both[k] * both[k] / seeds;
      }
    }
    const std::array spread{0.1, 0.3};
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_NEAR(mean[k], 1, 5 * spread[k] / std::sqrt(seeds)) << name_of(law);
      EXPECT_NEAR(std::sqrt(square[k] - mean[k] * mean[k]) / spread[k], 1, 0.05) << name_of(law);
    }
  }
}

TEST(Heterogeneity, LawsHaveTheirOwnTails) {
  // Weakest of 1000 places: a Weibull wall of the same spread is weaker there than a lognormal one.
  std::array<double, 2> weakest{1, 1};
  for (std::size_t k = 0; k < 2; ++k) {
    Parameters p = scattered(0.1, 0, k == 0 ? ScatterLaw::lognormal : ScatterLaw::weibull);
    resolve(p);
    for (p.scatter.seed = 0; p.scatter.seed < 1000; ++p.scatter.seed)
      weakest[k] = std::min(weakest[k], factors_at(Heterogeneity(p), {0, 0, 0}).critical_stretch);
  }
  EXPECT_LT(weakest[1], weakest[0] - 0.05);
}

TEST(Heterogeneity, IsTheSameWallAtTwoResolutions) {
  Parameters coarse = scattered(0.1, 0.1), fine = coarse;
  *fine.spacing = *coarse.spacing / 3;
  *fine.horizon = *coarse.horizon / 3;
  resolve(coarse);
  resolve(fine);
  const Lattice a = make_lattice(coarse), b = make_lattice(fine);
  const Heterogeneity in_coarse(coarse), in_fine(fine);
  int shared = 0;
  for (std::size_t i = 0; i < a.section.size(); i += 10) {
    for (std::size_t j = 0; j < b.section.size(); ++j) {
      if (std::hypot(a.section.x[i] - b.section.x[j], a.section.y[i] - b.section.y[j]) > 1e-9) continue;
      const auto f = factors_at(in_coarse, {a.section.x[i], a.section.y[i], a.height(4)});
      const auto g = factors_at(in_fine, {b.section.x[j], b.section.y[j], b.height(13)});
      EXPECT_NEAR(f.critical_stretch, g.critical_stretch, 1e-11);
      EXPECT_NEAR(f.stiffness, g.stiffness, 1e-11);
      ++shared;
    }
  }
  EXPECT_GT(shared, 50);
}

/// A body of 20 rows pulled along its axis, and what its bonds should do.
struct Pulled {
  BodySetup setup;
  std::unique_ptr<Body> body;
  const Observation* seen = nullptr;
  std::vector<std::vector<LocalFactors>> factors;  ///< [column][row]
  double strain = 0.1;

  explicit Pulled(const Parameters& p) : setup(test::setup_of(p, 1e-7)) {
    std::vector<double> z;
    for (std::int64_t r = 0; r < setup.lattice.rows; ++r) z.push_back(setup.lattice.height(r));
    const CrossSection& s = setup.lattice.section;
    for (std::size_t c = 0; c < s.size(); ++c)
      factors.push_back(setup.heterogeneity.along(s.x[c], s.y[c], z));
    body = make_body(BodySetup(setup), test::self());
    body->set_state(test::sample(*body,
                                 [&](auto x) {
                                   return std::array{0.0, 0.0, strain * x[2]};
                                 }),
                    test::sample(*body, test::nothing));
    seen = &body->observe(0);
  }

  /// Calls f(column, row, bond, stretch, the bond's factors).
  template <class Function>
  void for_each_bond(const Function& f) const {
    for (std::size_t c = 0; c < factors.size(); ++c) {
      for (std::int64_t r = 0; r < setup.lattice.rows; ++r) {
        for (std::int64_t b = setup.families->first[c]; b < setup.families->first[c + 1]; ++b) {
          const Bond& bond = setup.families->bonds[b];
          const std::int64_t other = r + bond.row_offset;
          if (other < 0 || other >= setup.lattice.rows) continue;
          const double y_z = (1 + strain) * bond.xi[2];
          const double y = std::sqrt(bond.xi[0] * bond.xi[0] + bond.xi[1] * bond.xi[1] + y_z * y_z);
          const LocalFactors &i = factors[c][r], &j = factors[bond.other][other];
          f(c, r, bond, y / bond.length - 1,
            LocalFactors{0.5 * (i.critical_stretch + j.critical_stretch), 0.5 * (i.stiffness + j.stiffness)});
        }
      }
    }
  }
};

TEST(HeterogeneousBody, EachBondBreaksAtItsOwnStretchAndTakesItsOwnEnergy) {
  Parameters p = scattered(0.2, 0.2);
  p.critical_stretch = 0.05;
  const Pulled pulled(p);
  const Lattice& lattice = pulled.setup.lattice;
  std::vector<double> whole(pulled.seen->damage.size()), broken(whole.size());
  double strain = 0, fracture = 0;
  std::int64_t count = 0, apart = 0;
  pulled.for_each_bond([&](std::size_t c, std::int64_t r, const Bond& bond, double s, const LocalFactors& f) {
    const std::size_t i = c * lattice.rows + r;
    const double s0 = *p.critical_stretch * f.critical_stretch;
    const double energy = 0.25 * pulled.setup.bond_constant * f.stiffness * bond.length * lattice.spacing *
                          lattice.volume(c) * lattice.volume(bond.other);
    whole[i] += lattice.volume(bond.other);
    (s >= s0 ? fracture : strain) += energy * (s >= s0 ? s0 * s0 : s * s);
    if (s >= s0) {
      broken[i] += lattice.volume(bond.other);
      ++count;
    }
    if ((s >= s0) != (s >= p.critical_stretch)) ++apart;
  });
  EXPECT_GT(apart, count / 10) << "scatter must decide for this test to mean anything";
  for (std::size_t i = 0; i < whole.size(); ++i)
    ASSERT_NEAR(pulled.seen->damage[i], broken[i] / whole[i], 1e-12);
  const Totals t = pulled.body->totals();
  EXPECT_EQ(t.broken_bonds, count / 2);
  EXPECT_NEAR(t.strain / strain, 1, 1e-12);
  EXPECT_NEAR(t.fracture / fracture, 1, 1e-12);
}

TEST(HeterogeneousBody, MomentumIsConserved) {
  Parameters p = scattered(0.1, 0.3);
  p.cross_section = Arrangement::polar;  // unequal volumes
  p.critical_stretch = 0.05;
  const Pulled pulled(p);
  EXPECT_GT(pulled.body->totals().broken_bonds, 0);
  double sum[3] = {}, size = 0;
  for (std::size_t i = 0; i < pulled.seen->damage.size(); ++i) {
    const double volume = pulled.setup.lattice.volume(i / pulled.setup.lattice.rows);
    for (int k = 0; k < 3; ++k) sum[k] += volume * pulled.seen->force_density[k][i];
    size += volume * std::abs(pulled.seen->force_density[2][i]);
  }
  for (double s : sum) EXPECT_NEAR(s, 0, 1e-13 * size);
}

TEST(HeterogeneousBody, EnergyBalancesThroughRupture) {
  Parameters p = scattered(0.1, 0.1, ScatterLaw::weibull);
  p.length = 1e-3;
  p.bond_precision = Precision::single_precision;
  p.critical_stretch = 0.05;
  BodySetup setup = test::setup_of(p, 1e-7);
  setup.time_step = 0.1 * test::stable_step_of(setup);
  const auto body = make_body(std::move(setup), test::self());
  const double rise = 200;  // Pa a step
  int steps = 0;
  std::int64_t broken = 0;
  for (; broken < 20000 && steps < 2000; ++steps)
    broken += body->advance(rise * steps, rise * (steps + 1)).broken;
  body->observe(rise * steps);
  const Totals t = body->totals();
  EXPECT_GT(t.broken_bonds, 9000);
  EXPECT_GT(t.fracture, 0.01 * t.external_work);
  EXPECT_NEAR((t.kinetic + t.strain + t.fracture) / t.external_work, 1, 1e-4);
}

TEST(HeterogeneousBody, StableStepIsThatOfTheStiffestPlace) {
  Parameters uniform = scattered(0.1, 0), stiff = scattered(0.1, 0.3);
  resolve(uniform);
  resolve(stiff);
  const Lattice lattice = make_lattice(stiff);
  const auto families = std::make_shared<const BondFamilies>(find_families(lattice));
  double largest = 0;
  for (const auto& column : Pulled(stiff).factors) {
    for (const LocalFactors& f : column) largest = std::max(largest, f.stiffness);
  }
  EXPECT_GT(largest, 1.5);
  EXPECT_NEAR(stable_time_step(make_setup(uniform, lattice, families, 0)) /
                  stable_time_step(make_setup(stiff, lattice, families, 0)),
              std::sqrt(largest), 1e-12);
}

TEST(HeterogeneousBody, StableStepIsThatOfTheMostExtensiblePlace) {
  // A wall that is one large spot, where bonds bear ten times the nominal stretch, is the wall of that
  // stretch.
  for (const char* law : {"pmb", "lps"}) {
    Parameters nominal = test::paper_vessel(4e-3);
    nominal.law.name = law;
    Parameters spotted = nominal, uniform = nominal;
    spotted.spots.list = {{.position = 2e-3, .radius = 1e3, .critical_stretch = 10}};
    uniform.critical_stretch = 10 * *spotted.critical_stretch;
    const auto stable = [](Parameters& p) {
      resolve(p);
      const Lattice lattice = make_lattice(p);
      return stable_time_step(make_setup(p, lattice, shared_families(p, lattice), 0));
    };
    EXPECT_NEAR(stable(spotted) / stable(uniform), 1, 1e-5) << law;
    EXPECT_LT(stable(uniform), 0.9 * stable(nominal)) << law;
  }
}

TEST(Scatter, UnresolvedCorrelationIsWarnedOf) {
  Parameters p = scattered(0.1, 0);
  EXPECT_TRUE(resolve(p).empty());
  EXPECT_EQ(*p.scatter.correlation_length, 2.5e-4);
  p.scatter.correlation_length = 1.9e-4;
  EXPECT_EQ(resolve(p).size(), 1U);
  p.scatter.correlation_length = 0.9e-5;
  EXPECT_THROW(resolve(p), rhexis::InputError);
}

}  // namespace
}  // namespace rhexis::peridynamics
