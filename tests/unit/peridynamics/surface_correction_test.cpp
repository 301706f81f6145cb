// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/bonds/surface_correction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <tuple>

#include "core/error.hpp"
#include "support/vessels.hpp"

namespace rhexis::peridynamics {
namespace {

Parameters vessel(const std::string& cross_section, const std::string& correction, double rotation = 0) {
  Parameters p = test::paper_vessel(2e-3);
  p.cross_section = value_of<Arrangement>(cross_section).value();
  p.surface_correction = value_of<SurfaceCorrection>(correction).value();
  p.rotation = rotation;
  resolve(p);
  return p;
}

struct Wall {
  Parameters p;
  Lattice lattice;
  BondFamilies families;
};

Wall wall(const std::string& cross_section, const std::string& correction, double rotation = 0) {
  Wall w{vessel(cross_section, correction, rotation), {}, {}};
  w.lattice = make_lattice(w.p);
  w.families = weighted_families(w.p, w.lattice);
  return w;
}

const std::pair<const char*, const char*> kinds[] = {{"lattice", "volume"},
                                                     {"lattice", "energy"},
                                                     {"polar", "volume"},
                                                     {"polar", "energy"},
                                                     {"polar", "calibrated"}};

// Else momentum would not be conserved.
TEST(SurfaceCorrection, BothEndsOfABondHaveTheSameWeightToTheLastBit) {
  for (const auto& [section, correction] : kinds) {
    const Wall w = wall(section, correction, 0.01);
    std::map<std::tuple<std::size_t, std::size_t, int>, double> weights;
    for (std::size_t i = 0; i < w.lattice.section.size(); ++i) {
      for (const Bond& b : w.families.of(i)) {
        weights[{i, static_cast<std::size_t>(b.other), b.row_offset}] = b.weight;
      }
    }
    for (const auto& [bond, weight] : weights) {
      const auto& [i, j, rows] = bond;
      ASSERT_EQ(weight, (weights.at({j, i, -rows}))) << section << ' ' << correction;
      ASSERT_GE(weight, least_weight);
    }
  }
}

// The bonds' energy density under strain e is c/4 sum_j w V_j |xi| (n.e.n)^2.
TEST(SurfaceCorrection, CalibratedWallHoldsTheEnergyOfEveryHomogeneousStrain) {
  const Wall w = wall("polar", "calibrated", 0.3);
  const CrossSection& s = w.lattice.section;
  const double c = Pmb::bond_constant(w.p.young_modulus, *w.p.horizon);
  // nu = 1/4: lambda = mu = 0.4 E; energy lambda tr(e)^2 / 2 + mu e:e.
  const double mu = 0.4 * w.p.young_modulus;
  const std::array<double, 3> strains[] = {{1, 0, 0}, {0, 1, 0},  {0, 0, 1},
                                           {1, 1, 0}, {1, -1, 0}, {0.3, 1, -0.5}};
  for (const std::array<double, 3>& e : strains) {  // principal, along (radial, hoop, axial)
    double energy = 0, volume = 0;
    for (std::size_t i = 0; i < s.size(); ++i) {
      const double r = std::hypot(s.x[i], s.y[i]);
      const double radial[2] = {s.x[i] / r, s.y[i] / r};
      double density = 0;
      for (const Bond& b : w.families.of(i)) {
        const double length = b.length * w.lattice.spacing;
        const double n[3] = {(b.xi[0] * radial[0] + b.xi[1] * radial[1]) / b.length,
                             (b.xi[1] * radial[0] - b.xi[0] * radial[1]) / b.length, b.xi[2] / b.length};
        const double stretch = e[0] * n[0] * n[0] + e[1] * n[1] * n[1] + e[2] * n[2] * n[2];
        density += c / 4 * b.weight * w.lattice.volume(static_cast<std::size_t>(b.other)) * length * stretch *
                   stretch;
      }
      energy += density * w.lattice.volume(i);
      volume += w.lattice.volume(i);
    }
    const double trace = e[0] + e[1] + e[2];
    const double exact = mu * (trace * trace / 2 + e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
    EXPECT_NEAR(energy / volume / exact, 1, 1e-5);
  }
}

// What no surface cuts needs no correction.
TEST(SurfaceCorrection, LeavesTheMiddleOfAThickWallNearlyAlone) {
  Parameters p = test::paper_vessel(1e-3);
  p.inner_radius = 5e-3;
  p.outer_radius = 7e-3;
  p.cross_section = Arrangement::polar;
  p.surface_correction = SurfaceCorrection::calibrated;
  resolve(p);
  const Lattice lattice = make_lattice(p);
  const BondFamilies families = weighted_families(p, lattice);
  for (std::size_t i = 0; i < lattice.section.size(); ++i) {
    const double r = std::hypot(lattice.section.x[i], lattice.section.y[i]);
    if (std::abs(r - 6e-3) > 5e-5) continue;
    for (const Bond& b : families.of(i)) EXPECT_NEAR(b.weight, 1, 0.35);
  }
}

TEST(SurfaceCorrection, ResultsDoNotDependOnHowTheSectionIsTurned) {
  const Wall straight = wall("polar", "calibrated"),
             turned = wall("polar", "calibrated", std::numbers::pi / 110);
  ASSERT_EQ(straight.families.bonds.size(), turned.families.bonds.size());
  const auto weights = [](const Wall& w) {
    std::vector<double> all;
    for (const Bond& b : w.families.bonds) all.push_back(b.weight);
    std::sort(all.begin(), all.end());
    return all;
  };
  const std::vector<double> a = weights(straight), b = weights(turned);
  for (std::size_t k = 0; k < a.size(); ++k) ASSERT_NEAR(a[k], b[k], 1e-9);
}

TEST(SurfaceCorrection, CalibrationNeedsAPolarSection) {
  EXPECT_THROW(vessel("lattice", "calibrated"), InputError);
  EXPECT_EQ(surface_correction(vessel("lattice", "auto")), SurfaceCorrection::none);
  EXPECT_EQ(surface_correction(vessel("polar", "auto")), SurfaceCorrection::calibrated);
}

}  // namespace
}  // namespace rhexis::peridynamics
