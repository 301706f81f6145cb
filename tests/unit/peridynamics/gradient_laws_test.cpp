// SPDX-License-Identifier: BSD-3-Clause
// Laws by deformation gradient: stress as the derivative of energy, fibres, layers, and an artery's wall
// under pressure against its closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "core/error.hpp"
#include "peridynamics/stability/time_steps.hpp"
#include "peridynamics/statics/equilibrium.hpp"
#include "support/vessels.hpp"

namespace rhexis::peridynamics {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// The rabbit carotid of Holzapfel, Gasser & Ogden 2000, Table 2, without its opening angle.
LayerInput carotid() {
  LayerInput input;
  input.layers = {{"media", 2.0 / 3, 3e3}, {"adventitia", 1.0 / 3, 0.3e3}};
  for (const double sign : {1.0, -1.0}) {
    input.fibres.push_back({.layer = "media", .angle = sign * 29 * degree, .k1 = 2.3632e3, .k2 = 0.8393});
    input.fibres.push_back(
        {.layer = "adventitia", .angle = sign * 62 * degree, .k1 = 0.5620e3, .k2 = 0.7112});
  }
  return input;
}

const WallFrame frame{.radial = {1, 0, 0}, .axial = {0, 0, 1}, .depth = 0.2F};

/// The law at one particle that stands in `frame`.
template <class Law>
typename Law::template AtParticles<double> at_particle(const Law& law) {
  return {law, {&frame}};
}

template <class Law>
void expect_stress_is_the_derivative_of_energy(const Law& law) {
  const auto here = at_particle(law);
  std::array<double, 9> h{0.1, 0.05, 0.02, -0.07, 0.2, 0.03, 0.01, 0.04, 0.1};
  const auto tensor = [](const std::array<double, 9>& a) {
    return Tensor<double>{a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8]};
  };
  const Tensor<double> p = here.stress(Deformation<double>(tensor(h)), 0);
  const std::array<double, 9> stress{p.xx, p.xy, p.xz, p.yx, p.yy, p.yz, p.zx, p.zy, p.zz};
  constexpr double step = 1e-6;
  for (std::size_t k = 0; k < 9; ++k) {
    auto above = h, below = h;
    above[k] += step;
    below[k] -= step;
    const double slope = (here.energy(Deformation<double>(tensor(above)), 0) -
                          here.energy(Deformation<double>(tensor(below)), 0)) /
                         (2 * step);
    EXPECT_NEAR(stress[k], slope, 1e-8) << k;
  }
}

TEST(GradientLaws, StressIsTheDerivativeOfEnergy) {
  expect_stress_is_the_derivative_of_energy(NeoHookean(1e6, 0.45));
  expect_stress_is_the_derivative_of_energy(FibreReinforced(wall_layers(carotid()), 0.45));
  LayerInput dispersed = carotid();
  for (FibreFamily& family : dispersed.fibres) family.dispersion = 0.2;
  expect_stress_is_the_derivative_of_energy(FibreReinforced(wall_layers(dispersed), 0.45));
}

TEST(GradientLaws, FibresBearTensionOnly) {
  LayerInput input;
  input.layers = {{"wall", 1, 1e3}};
  input.fibres = {{.layer = "wall", .angle = 0, .k1 = 5e3, .k2 = 2}};
  const auto with = at_particle(FibreReinforced(wall_layers(input), 0.3));
  input.fibres.clear();
  const auto without = at_particle(FibreReinforced(wall_layers(input), 0.3));
  // The circumference at the frame is the y axis.
  const auto hoop_stress = [](const auto& law, double stretch) {
    return law.stress(Deformation<double>({0, 0, 0, 0, stretch - 1, 0, 0, 0, 0}), 0).yy;
  };
  EXPECT_EQ(hoop_stress(with, 0.9), hoop_stress(without, 0.9));
  const double e = 1.1 * 1.1 - 1;
  EXPECT_NEAR(hoop_stress(with, 1.1) - hoop_stress(without, 1.1), 2 * 5 * e * std::exp(2 * e * e) * 1.1,
              1e-12);
  EXPECT_NEAR(with.fibre_stretch(Deformation<double>({0, 0, 0, 0, 0.1, 0, 0, 0, 0}), 0), 1.1, 1e-14);
}

TEST(GradientLaws, FullDispersionHasNoDirection) {
  LayerInput input;
  input.layers = {{"wall", 1, 1e3}};
  input.fibres = {{.layer = "wall", .angle = 0.3, .k1 = 5e3, .k2 = 2, .dispersion = 1.0 / 3}};
  const auto law = at_particle(FibreReinforced(wall_layers(input), 0.3));
  EXPECT_NEAR(law.energy(Deformation<double>({0.2, 0, 0, 0, 0, 0, 0, 0, 0}), 0),
              law.energy(Deformation<double>({0, 0, 0, 0, 0.2, 0, 0, 0, 0}), 0), 1e-14);
}

Parameters artery(double poisson_ratio) {
  Parameters p = test::paper_vessel(0.26e-3);
  p.inner_radius = 0.71e-3;
  p.outer_radius = 1.10e-3;
  p.cross_section = Arrangement::polar;
  p.spacing = 0.39e-3 / 6;
  p.horizon.reset();
  p.law.name = FibreReinforced::name;
  p.law.poisson_ratio = poisson_ratio;
  p.law.wall = carotid();
  p.critical_stretch = 0.8;
  p.ends = EndCondition::sliding;
  p.end_length = *p.spacing;
  p.direction = LoadDirection::follower;
  p.bond_precision = Precision::double_precision;
  p.end_time = 1e-6;
  return p;
}

TEST(GradientLaws, InputOfLayersIsChecked) {
  const auto key_at_fault = [](const Parameters& given) -> std::string {
    Parameters p = given;
    try {
      resolve(p);
    } catch (const InputError& e) {
      return e.key;
    }
    return "";
  };
  Parameters p = artery(0.49);
  EXPECT_EQ(key_at_fault(p), "");
  p.law.wall.layers[0].thickness = 0.5;
  EXPECT_EQ(key_at_fault(p), "layer[2].thickness");
  p = artery(0.49);
  p.law.wall.fibres[1].layer = "intima";
  EXPECT_EQ(key_at_fault(p), "fibre[2].layer");
  p = artery(0.49);
  p.law.wall.layers.clear();
  EXPECT_EQ(key_at_fault(p), "material.law");
  p = artery(0.49);
  p.law.name = "neo_hookean";
  EXPECT_EQ(key_at_fault(p), "layer[1].shear_modulus");
  p = artery(0.49);
  p.law.wall.fibres[0].k2 = 50;
  EXPECT_EQ(key_at_fault(p), "material.critical_stretch");
}

/// Energy density of the incompressible wall at the hoop stretch l and axial stretch 1, dW/dl; Pa.
double hoop_slope(const WallLayer& layer, double l) {
  double slope = layer.shear_modulus * (l - 1 / (l * l * l));
  for (const FibreFamily& family : layer.fibres) {
    const double c2 = std::pow(std::cos(family.angle), 2), e = std::max(0.0, (l * l - 1) * c2);
    slope += family.k1 * e * std::exp(family.k2 * e * e) * 2 * l * c2;
  }
  return slope;
}

/// Pressure of the incompressible thick tube at the lumen's stretch, by dP = W'(l) / (l^2 - 1) dl (Holzapfel,
/// Gasser & Ogden 2000, Sec. 4.2, without residual stress); Pa.
double closed_form_pressure(const Parameters& p, double lumen_stretch) {
  const std::vector<WallLayer> layers = wall_layers(p.law.wall);
  const auto stretch_at = [&](double radius) {
    return std::sqrt(1 + (lumen_stretch * lumen_stretch - 1) * std::pow(p.inner_radius / radius, 2));
  };
  double pressure = 0, inside = p.inner_radius;
  for (const WallLayer& layer : layers) {
    const double outside = inside + layer.thickness * (p.outer_radius - p.inner_radius);
    const double low = stretch_at(outside), high = stretch_at(inside);
    constexpr int parts = 2000;
    for (int i = 0; i < parts; ++i) {
      const double l = low + (high - low) * (i + 0.5) / parts;
      pressure += (high - low) / parts * hoop_slope(layer, l) / (l * l - 1);
    }
    inside = outside;
  }
  return pressure;
}

TEST(GradientLaws, AnArteryOfTwoLayersExpandsAsItsClosedFormSays) {
  Parameters p = artery(0.499);
  resolve(p);
  const SharedWall wall = make_wall(p);
  for (const double stretch : {1.5}) {
    const Equilibrium e =
        find_equilibrium(*wall, closed_form_pressure(p, stretch), 1e-4, test::self(), 40000);
    const ParticleSet& set = wall->general.setup->geometry->particles;
    double found = 0, exact = 0;
    for (std::size_t i = 0; i < set.size(); ++i) {
      const double x = set.position[0][i], y = set.position[1][i], r = std::hypot(x, y);
      const double now = std::hypot(x + e.displacement[0][i], y + e.displacement[1][i]);
      found += set.volume[i] * (now - r);
      exact +=
          set.volume[i] * (std::sqrt(r * r + (stretch * stretch - 1) * p.inner_radius * p.inner_radius) - r);
    }
    std::printf("lumen stretch %g: %ld steps, displacement off by %.3f %%\n", stretch, e.steps,
                100 * (found / exact - 1));
    EXPECT_NEAR(found / exact, 1, 0.02);
  }
}

}  // namespace
}  // namespace rhexis::peridynamics
