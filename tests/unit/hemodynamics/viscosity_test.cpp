// SPDX-License-Identifier: BSD-3-Clause
// Apparent viscosity: the published laws at haematocrit 0.45, their limits, and Poiseuille's law.
#include "hemodynamics/viscosity.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "hemodynamics/poiseuille.hpp"

namespace rhexis::hemodynamics {
namespace {

TEST(Viscosity, TableOfBothLaws) {
  struct Row {
    double diameter_um, in_vitro, in_vivo;
  };
  // Evaluated by hand from the published formulas, four digits.
  for (const Row& row : {Row{4, 2.307, 17.70}, Row{6, 1.274, 10.01}, Row{10, 1.328, 5.872},
                         Row{40, 1.924, 2.314}, Row{1000, 3.186, 3.198}}) {
    EXPECT_NEAR(relative_viscosity(ViscosityLaw::in_vitro, row.diameter_um, 0.45) / row.in_vitro, 1, 5e-4);
    EXPECT_NEAR(relative_viscosity(ViscosityLaw::in_vivo, row.diameter_um, 0.45) / row.in_vivo, 1, 5e-4);
  }
}

TEST(Viscosity, NoCellsIsPlasma) {
  EXPECT_NEAR(relative_viscosity(ViscosityLaw::in_vitro, 30.0, 1e-12), 1, 1e-10);
}

TEST(Viscosity, RisesWithHaematocrit) {
  for (const auto law : {ViscosityLaw::in_vitro, ViscosityLaw::in_vivo}) {
    for (const double d : {5.0, 20.0, 300.0}) {
      double before = 0;
      for (double h = 0.05; h < 0.9; h += 0.05) {
        const double now = relative_viscosity(law, d, h);
        EXPECT_GT(now, before);
        before = now;
      }
    }
  }
}

TEST(Viscosity, StaysFiniteInTheNarrowestVessels) {
  Viscosity v;
  v.law = ViscosityLaw::in_vivo;
  const double at_least = apparent_viscosity(v, v.least_diameter / 2, 0.45);
  for (const double diameter : {1.1e-6, 1.0e-6, 1e-9}) {
    EXPECT_EQ(apparent_viscosity(v, diameter / 2, 0.45), at_least);
  }
  EXPECT_GT(apparent_viscosity(v, 0.551e-6 * 1.9, 0.45), 0);
  // What the clamp spares: the law itself has no value at 1.1 um.
  EXPECT_TRUE(std::isinf(relative_viscosity(ViscosityLaw::in_vivo, 1.1, 0.45)));
}

TEST(Viscosity, DiametersAreInUnitsOfTheRedCells) {
  Viscosity man{.law = ViscosityLaw::in_vivo}, rat = man;
  rat.mean_cell_volume = 55e-18;
  EXPECT_EQ(man.diameter_scale(), 1);
  EXPECT_NEAR(rat.diameter_scale(), 1.18707, 1e-5);  // (92/55)^(1/3)
  // A vessel of a rat is like one of a man that is wider by as much.
  EXPECT_NEAR(apparent_viscosity(rat, 3e-6, 0.45) / apparent_viscosity(man, 3e-6 * 1.187070, 0.45), 1, 1e-5);
  // The least diameter is compared with the scaled one.
  EXPECT_EQ(man.least_radius(), 1e-6);
  EXPECT_EQ(apparent_viscosity(rat, rat.least_radius() * 0.9, 0.45), apparent_viscosity(man, 1e-6, 0.45));
  EXPECT_LT(apparent_viscosity(rat, rat.least_radius() * 1.1, 0.45), apparent_viscosity(man, 1e-6, 0.45));
}

TEST(Viscosity, DoubleAgreesWithLongDouble) {
  for (double d = 2; d < 3e4; d *= 1.37) {
    for (const auto law : {ViscosityLaw::in_vitro, ViscosityLaw::in_vivo}) {
      EXPECT_NEAR(relative_viscosity(law, d, 0.3) /
                      static_cast<double>(relative_viscosity(law, static_cast<long double>(d), 0.3L)),
                  1, 2e-14);
    }
  }
}

TEST(Poiseuille, ResistanceAndShear) {
  EXPECT_NEAR(poiseuille_resistance(1e-3, 0.1, 3.5e-3), 8 * 3.5e-3 * 0.1 / (std::numbers::pi * 1e-12), 1e-3);
  // Shear on the wall carries the pressure drop: tau 2 pi r L = dP pi r^2.
  const double r = 2e-3, length = 0.05, eta = 4e-3, q = 1e-6;
  const double drop = q * poiseuille_resistance(r, length, eta);
  EXPECT_NEAR(wall_shear_stress(r, eta, q) * 2 * length / (drop * r), 1, 1e-14);
}

TEST(Poiseuille, ReynoldsNumberIsOfDiameterAndMeanVelocity) {
  const double r = 2e-3, eta = 4e-3, velocity = 0.3, q = velocity * std::numbers::pi * r * r;
  for (const double flow : {q, -q})
    EXPECT_NEAR(reynolds_number(r, eta, flow, 1060.0), 1060 * velocity * 2 * r / eta, 1e-9);
}

}  // namespace
}  // namespace rhexis::hemodynamics
