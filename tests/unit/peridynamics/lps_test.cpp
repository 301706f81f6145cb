// SPDX-License-Identifier: BSD-3-Clause
// The linear peridynamic solid: its moduli on the lattice, what it is at nu = 1/4, and its stable time step.
#include "peridynamics/laws/lps.hpp"

#include <gtest/gtest.h>

#include "peridynamics/stability/time_steps.hpp"
#include "support/vessels.hpp"

namespace rhexis::peridynamics {
namespace {

Parameters solid_of(double poisson_ratio) {
  Parameters p = test::paper_vessel(1e-3);
  p.law.name = "lps";
  p.law.poisson_ratio = poisson_ratio;
  p.ends = EndCondition::free;
  p.bond_precision = Precision::double_precision;
  return p;
}

struct Moduli {
  double bulk, shear;  ///< Pa
};
Moduli moduli(const Parameters& p) {
  return {p.young_modulus / (3 * (1 - 2 * p.law.poisson_ratio)),
          p.young_modulus / (2 * (1 + p.law.poisson_ratio))};
}

TEST(Lps, ConstantsAreTheModuli) {
  for (double nu : {-0.5, 0.0, 0.25, 0.4, 0.49}) {
    const Parameters p = solid_of(nu);
    const auto [bulk, shear] = moduli(p);
    const double horizon = 3.5e-4;
    const Lps law(nu);
    EXPECT_NEAR(law.kappa(), (3 * bulk - 5 * shear) / (15 * shear), 1e-12);
    const double c_m = law.bond_constant(p.young_modulus, horizon) * Lps::weighted_volume(horizon);
    EXPECT_NEAR(c_m / (30 * shear), 1, 1e-14);
    EXPECT_NEAR(c_m * law.dilatation_energy(0.1), 0.5 * (bulk - 5 * shear / 3) * 0.01, 1e-9 * bulk);
  }
  EXPECT_EQ(Lps(0.25).kappa(), 0);
}

/// Energy density in the middle of a rod under u = strain x.
struct Rod {
  double energy, weighted_volume, shear_sum;
};
Rod strained(double nu, const std::array<std::array<double, 3>, 3>& strain) {
  Parameters p = solid_of(nu);
  p.inner_radius = 1e-6;
  p.outer_radius = 4.5e-4;
  const BodySetup setup = test::setup_of(p, 1e-7);
  const auto body = make_body(BodySetup(setup), test::self());
  body->set_state(test::sample(*body,
                               [&](auto x) {
                                 std::array<double, 3> u{};
                                 for (std::size_t k = 0; k < 3; ++k) {
                                   for (std::size_t l = 0; l < 3; ++l) u[k] += strain[k][l] * x[l];
                                 }
                                 return u;
                               }),
                  test::sample(*body, test::nothing));
  const CrossSection& s = setup.lattice.section;
  std::size_t middle = 0;
  for (std::size_t c = 0; c < s.size(); ++c) {
    if (std::hypot(s.x[c], s.y[c]) < std::hypot(s.x[middle], s.y[middle])) middle = c;
  }
  Rod rod{};
  for (std::int64_t b = setup.families->first[middle]; b < setup.families->first[middle + 1]; ++b) {
    const Bond& bond = setup.families->bonds[static_cast<std::size_t>(b)];
    rod.weighted_volume += bond.length;
    rod.shear_sum += std::pow(bond.xi[0] * bond.xi[1], 2) / std::pow(bond.length, 3);
  }
  const double whole = Lps::weighted_volume(3.5);
  rod.weighted_volume /= whole;
  rod.shear_sum /= whole;
  const std::int64_t rows = body->columns()->rows;
  rod.energy = body->observe(0).strain_energy_density[middle * static_cast<std::size_t>(rows) +
                                                      static_cast<std::size_t>(rows / 2)];
  return rod;
}

TEST(Lps, ExpansionAndShearHaveTheirModuliUpToTheLattice) {
  // A family of 178 has 0.994 of the ball's weighted volume, and 0.960 of its integral for shear.
  for (double nu : {0.0, 0.25, 0.4, 0.49}) {
    const auto [bulk, shear] = moduli(solid_of(nu));
    const double e = 1e-6;
    const Rod expanded = strained(nu, {{{e, 0, 0}, {0, e, 0}, {0, 0, e}}});
    const double a = expanded.weighted_volume;
    const double exact = 4.5 * e * e * ((bulk - 5 * shear / 3) * a * a + 5 * shear / 3 * a);
    EXPECT_NEAR(expanded.energy / exact, 1, 1e-5);
    const Rod sheared = strained(nu, {{{0, e, 0}, {e, 0, 0}, {0, 0, 0}}});
    EXPECT_NEAR(sheared.energy / (30 * shear * e * e * sheared.shear_sum), 1, 1e-5);
    std::printf("nu = %.2f: bulk modulus x %.4f, shear modulus x %.4f\n", nu,
                expanded.energy / (4.5 * bulk * e * e), sheared.energy / (2 * shear * e * e));
    EXPECT_NEAR(expanded.energy / (4.5 * bulk * e * e), 1, 0.013);
    EXPECT_NEAR(sheared.energy / (2 * shear * e * e), 0.960, 0.001);
  }
}

TEST(Lps, IsPmbToTheLastBitAtOneQuarter) {
  for (const char* precision : {"single", "double"}) {
    std::array<std::array<std::vector<double>, 3>, 2> forces;
    std::array<Totals, 2> totals;
    for (std::size_t i = 0; i < 2; ++i) {
      Parameters p = solid_of(0.25);
      p.law.name = i == 0 ? "pmb" : "lps";
      p.bond_precision = value_of<Precision>(precision).value();
      p.critical_stretch = 0.1;
      BodySetup setup = test::setup_of(p, 1e-6);
      // c is the same number by another formula; only its last digits differ.
      EXPECT_NEAR(setup.bond_constant / Pmb::bond_constant(p.young_modulus, 3.5e-4), 1, 1e-14);
      setup.bond_constant = Pmb::bond_constant(p.young_modulus, 3.5e-4);
      const auto body = make_body(std::move(setup), test::self());
      for (int step = 0; step < 60; ++step) body->advance(300e3, 300e3);
      forces[i] = body->observe(300e3).force_density;
      totals[i] = body->totals();
    }
    EXPECT_EQ(forces[0], forces[1]);
    EXPECT_GT(totals[0].broken_bonds, 1000);
    EXPECT_EQ(totals[0].broken_bonds, totals[1].broken_bonds);
    EXPECT_EQ(totals[0].fracture, totals[1].fracture);
  }
}

/// 2 / sqrt of the largest eigenvalue of the accelerations, from below: power iteration.
double longest_stable_step(const Parameters& p) {
  BodySetup setup = test::setup_of(p, 1e-7);
  const double amplitude = 1e-6 * setup.lattice.spacing, density = setup.density;
  const Lattice lattice = setup.lattice;
  const auto body = make_body(std::move(setup), test::self());
  unsigned noise = 1;
  std::array<std::vector<double>, 3> u = test::sample(*body, [&](auto) {
    std::array<double, 3> v{};
    for (double& component : v)
      component = static_cast<double>((noise = noise * 1664525u + 1013904223u) >> 8);
    return v;
  });
  const auto still = test::sample(*body, test::nothing);
  const auto rows = static_cast<std::size_t>(body->columns()->rows);
  const auto product = [&](const auto& a, const auto& b) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < a[k].size(); ++i) sum += lattice.volume(i / rows) * a[k][i] * b[k][i];
    }
    return sum;
  };
  double eigenvalue = 0;
  for (int iteration = 0; iteration < 60; ++iteration) {
    double largest = 0;
    for (const auto& component : u) {
      for (double x : component) largest = std::max(largest, std::abs(x));
    }
    for (auto& component : u) {
      for (double& x : component) x *= amplitude / largest;
    }
    body->set_state(u, still);
    auto next = body->observe(0).force_density;
    for (auto& component : next) {
      for (double& x : component) x /= -density;
    }
    eigenvalue = product(u, next) / product(u, u);
    u = std::move(next);
  }
  return 2 / std::sqrt(eigenvalue);
}

TEST(Lps, StableStepIsSafeAndNotWasteful) {
  for (const char* ends : {"free", "axial_periodic"}) {
    for (double nu : {0.25, 0.49}) {
      Parameters p = solid_of(nu);
      p.ends = value_of<EndCondition>(ends).value();
      p.cross_section = Arrangement::polar;
      resolve(p);
      const Lattice lattice = make_lattice(p);
      const double bound = stable_time_step(make_setup(p, lattice, shared_families(p, lattice), 0)),
                   longest = longest_stable_step(p);
      std::printf("nu = %.2f, %s: stable step %.4g s, %.3f of the longest\n", nu, ends, bound,
                  bound / longest);
      EXPECT_LT(bound, longest);
      EXPECT_GT(bound, 0.4 * longest);
    }
  }
}

}  // namespace
}  // namespace rhexis::peridynamics
