// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/engine/general_body.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "peridynamics/statics/elastic_error.hpp"
#include "peridynamics/statics/small_strain.hpp"

namespace rhexis::peridynamics {
namespace {

using Field = std::array<std::vector<double>, 3>;
using Matrix = std::array<std::array<double, 3>, 3>;

constexpr double spacing = 1e-4;
constexpr double volume_of_cell = spacing * spacing * spacing;

/// Moves particles at random, each by up to `by` spacings along each axis; the surface stays.
ParticleSet disturbed(ParticleSet set, double by) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-by * set.spacing, by * set.spacing);
  std::vector<Vector3> moved(set.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) set.position[k][i] += moved[i][k] = uniform(random);
  }
  for (SurfacePatch& patch : set.surface) {
    for (std::size_t k = 0; k < 3; ++k) patch.offset[k] -= moved[patch.particle][k];
  }
  return set;
}

std::shared_ptr<GeneralSetup> setup_of(const ParticleSet& set, double horizon_ratio, double poisson_ratio,
                                       double tolerance = 1e-8) {
  auto setup = std::make_shared<GeneralSetup>();
  setup->geometry = make_geometry(set, horizon_ratio * set.spacing, nullptr, nullptr, tolerance);
  setup->law = NeoHookean(3.5e6, poisson_ratio);
  setup->density = 1300;
  setup->critical_stretch = 10;
  setup->time_step = 1e-7;
  setup->energy_scale = 1e-3;
  setup->double_bonds = true;
  return setup;
}

Field zero(const Body& body) {
  Field field;
  for (auto& component : field) component.assign(static_cast<std::size_t>(body.ids().local_count()), 0.0);
  return field;
}

/// Sets u = H x, with no velocity.
void deform(Body& body, const Matrix& h) {
  Field u = zero(body);
  for (std::size_t i = 0; i < u[0].size(); ++i) {
    const auto x = body.reference_position(i);
    for (std::size_t k = 0; k < 3; ++k) u[k][i] = h[k][0] * x[0] + h[k][1] * x[1] + h[k][2] * x[2];
  }
  body.set_state(u, zero(body));
}

double largest(const Field& field) {
  double most = 0;
  for (const auto& component : field) {
    for (const double x : component) most = std::max(most, std::abs(x));
  }
  return most;
}

const Matrix homogeneous{{{0.1, 0.05, 0}, {-0.02, 0.2, 0.03}, {0.01, 0, -0.1}}};

TEST(GeneralBody, HoldsTheExactEnergyOfAHomogeneousStrainAtEveryParticle) {
  const auto setup = setup_of(disturbed(box_particles({6, 7, 8}, spacing), 0.15), 2.2, 0.3);
  const auto body = make_body(setup, parallel::Communicator::self());
  deform(*body, homogeneous);
  const auto& law = std::get<NeoHookean>(setup->law);
  const double exact =
      law.shear_modulus *
      neo_hookean_energy(Deformation<double>({0.1, 0.05, 0, -0.02, 0.2, 0.03, 0.01, 0, -0.1}), law.lame);
  for (const double energy : body->observe(0).strain_energy_density)
    EXPECT_NEAR(energy, exact, 1e-10 * exact);
}

TEST(GeneralBody, ForcesInSinglePrecisionAreThoseInDouble) {
  const auto setup = setup_of(disturbed(sphere_particles(3e-4, 6e-4, 3), 0.1), 2.2, 0.3);
  const auto single = std::make_shared<GeneralSetup>(*setup);
  single->double_bonds = false;
  Field force[2];
  for (const bool doubles : {true, false}) {
    const auto body = make_body(doubles ? setup : single, parallel::Communicator::self());
    deform(*body, homogeneous);
    force[doubles] = body->force_density(1e5);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < force[0][k].size(); ++i)
      EXPECT_NEAR(force[0][k][i], force[1][k][i], 1e-5 * largest(force[1])) << i;
  }
}

TEST(GeneralBody, HomogeneousStressPushesNoParticleInside) {
  for (const auto& [moved, tolerance] : {std::pair{0.0, 1e-7}, std::pair{0.15, 1e-6}}) {
    const ParticleSet set = disturbed(box_particles({9, 9, 9}, spacing), moved);
    const auto body = make_body(setup_of(set, 1.8, 0.3), parallel::Communicator::self());
    deform(*body, homogeneous);
    const Field force = body->observe(0).force_density;
    double inside = 0;
    for (std::size_t i = 0; i < force[0].size(); ++i) {
      const auto x = body->reference_position(i);
      double depth = INFINITY;
      for (std::size_t k = 0; k < 3; ++k) depth = std::min({depth, x[k], 9 * spacing - x[k]});
      if (depth > 2.65 * spacing)
        inside = std::max({inside, std::abs(force[0][i]), std::abs(force[1][i]), std::abs(force[2][i])});
    }
    EXPECT_GT(inside, 0);
    EXPECT_LT(inside, tolerance * largest(force)) << moved;
  }
}

TEST(GeneralBody, StandsUnderAPressureAllAroundAtTheStressThatBalancesIt) {
  ParticleSet set = disturbed(sphere_particles(3e-4, 6e-4, 3), 0.1);
  for (SurfacePatch& patch : set.surface) patch.loaded = true;
  const auto setup = setup_of(set, 2.2, 0.3);
  const auto body = make_body(setup, parallel::Communicator::self());
  const double h = -0.05;
  deform(*body, {{{h, 0, 0}, {0, h, 0}, {0, 0, h}}});
  // P = -p cof F
  const Deformation<double> f({h, 0, 0, 0, h, 0, 0, 0, h});
  const auto& law = std::get<NeoHookean>(setup->law);
  const double pressure = -law.shear_modulus * neo_hookean_stress(f, law.lame).xx / f.area_map().xx;
  const Field balanced = body->observe(pressure).force_density;
  EXPECT_LT(largest(balanced), 1e-4 * pressure / spacing);
}

TEST(GeneralBody, ForcesAreTheDerivativeOfTheEnergyAndTurnWithTheBody) {
  const auto setup = setup_of(disturbed(box_particles({5, 6, 7}, spacing), 0.1), 2.2, 0.45);
  const auto body = make_body(setup, parallel::Communicator::self());
  Field u = zero(*body);
  const Field rest = u;
  for (std::size_t i = 0; i < u[0].size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      u[k][i] = 0.05 * spacing * std::sin(7.3 * static_cast<double>(i + 11 * k));
  }
  const std::vector<double> volumes = body->volumes();
  const auto energy = [&](const Field& at) {
    body->set_state(at, rest);
    const Observation& seen = body->observe(0);
    double sum = 0;
    for (std::size_t i = 0; i < volumes.size(); ++i) sum += volumes[i] * seen.strain_energy_density[i];
    return sum;
  };
  body->set_state(u, rest);
  const Field force = body->observe(0).force_density;
  for (const std::size_t i : {std::size_t{3}, std::size_t{100}, std::size_t{180}}) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double step = 1e-4 * spacing;
      Field there = u;
      there[k][i] += step;
      const double above = energy(there);
      there[k][i] -= 2 * step;
      EXPECT_NEAR(force[k][i] * volumes[i], (energy(there) - above) / (2 * step),
                  1e-6 * largest(force) * volume_of_cell);
    }
  }

  // The same, turned by a right angle and some about z.
  const double c = std::cos(2.0), s = std::sin(2.0);
  Field turned = u;
  for (std::size_t i = 0; i < u[0].size(); ++i) {
    const auto x = body->reference_position(i);
    const double px = x[0] + u[0][i], py = x[1] + u[1][i];
    turned[0][i] = c * px - s * py - x[0];
    turned[1][i] = s * px + c * py - x[1];
  }
  body->set_state(turned, rest);
  const Observation& seen = body->observe(0);
  for (std::size_t i = 0; i < u[0].size(); ++i) {
    EXPECT_NEAR(seen.force_density[0][i], c * force[0][i] - s * force[1][i], 1e-8 * largest(force));
    EXPECT_NEAR(seen.force_density[2][i], force[2][i], 1e-8 * largest(force));
  }
}

Lattice tube(double inner_radius, double outer_radius, std::int64_t rows) {
  Lattice lattice;
  lattice.section = polar_cross_section(inner_radius, outer_radius, spacing);
  lattice.rows = rows;
  lattice.row_spacing = lattice.spacing = spacing;
  return lattice;
}

/// Relative L2 error (%) of the expansion of the paper's tube under a small pressure against Lame's; plane
/// strain. Particles are `moved` at random by as many spacings.
double error_of_tube(double poisson_ratio, double moved) {
  Parameters p;
  p.inner_radius = 1.5e-3;
  p.outer_radius = 2e-3;
  p.law.poisson_ratio = poisson_ratio;
  const Lattice lattice = tube(1.5e-3, 2e-3, 16);
  auto setup = setup_of(disturbed(tube_particles(lattice), moved), 2.2, poisson_ratio, 1e-3);
  const ParticleSet& set = setup->geometry->particles;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const double z = set.position[2][i];
    setup->held.push_back(z < spacing || z > 15 * spacing ? 4 : 0);
  }
  const auto body = make_body(setup, parallel::Communicator::self());
  const SmallStrain found = find_small_strain(*body, 1e-5 * spacing, 1e-6, parallel::Communicator::self());
  double error = 0, size = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const double x = set.position[0][i], y = set.position[1][i], r = std::hypot(x, y);
    const double exact = lame_displacement(p, 1, r);
    error += set.volume[i] *
             (std::pow(found.displacement[0][i] - exact * x / r, 2) +
              std::pow(found.displacement[1][i] - exact * y / r, 2) + std::pow(found.displacement[2][i], 2));
    size += set.volume[i] * exact * exact;
  }
  return 100 * std::sqrt(error / size);
}

TEST(GeneralBody, ATubeOfFiveLayersExpandsAsLameSays) {
  EXPECT_LT(error_of_tube(0.25, 0), 0.6);
  EXPECT_LT(error_of_tube(0.49, 0), 1.15);
  EXPECT_LT(error_of_tube(0.49, 0.15), 1.15);
}

}  // namespace
}  // namespace rhexis::peridynamics
