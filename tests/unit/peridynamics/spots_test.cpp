// SPDX-License-Identifier: BSD-3-Clause
// Spots given by place: weaker, softer or stiffer, and thinner ones.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "peridynamics/monitors/opening.hpp"
#include "support/vessels.hpp"

namespace rhexis::peridynamics {
namespace {

constexpr double mid_radius = 1.75e-3;  // of the paper's wall

/// The paper's vessel with one spot at 2 mm, on the far side from the x axis.
Parameters spotted(double critical_stretch, double stiffness, double thickness) {
  Parameters p = test::paper_vessel(4e-3);
  p.layer = LayerForce::consistent;
  p.ends = EndCondition::axial_periodic;
  p.critical_stretch = 0.1;
  p.spots.list = {{.position = 2e-3,
                   .angle = std::numbers::pi,
                   .radius = 1e-3,
                   .critical_stretch = critical_stretch,
                   .stiffness = stiffness,
                   .thickness = thickness}};
  return p;
}

/// Calls f(particle, reference position, column) for all particles of a body on one rank.
template <class Function>
void for_each_particle(const Body& body, const Function& f) {
  const ColumnLayout& l = *body.columns();
  for (std::int64_t c = 0; c < l.columns; ++c) {
    for (std::int64_t r = 0; r < l.rows; ++r) {
      const std::size_t i = l.particle(c, r);
      f(i, body.reference_position(i), static_cast<std::size_t>(c));
    }
  }
}

/// Distance from the centre of the spot, along the wall at mid-radius.
double distance(const std::array<double, 3>& x) {
  return std::hypot(x[2] - 2e-3, mid_radius * std::abs(std::atan2(x[1], -x[0])));
}

TEST(Spots, FactorsGoOverToOneAlongTheWall) {
  const Heterogeneity wall(spotted(0.4, 3, 1));
  const auto at = [&](double angle, double z) {
    const double heights[] = {z};
    return wall.along(1.9e-3 * std::cos(angle), 1.9e-3 * std::sin(angle), heights).front();
  };
  const double half = 0.5e-3, pi = std::numbers::pi;
  EXPECT_NEAR(at(pi, 2e-3).critical_stretch, 0.4, 1e-15);
  EXPECT_NEAR(at(pi, 2e-3).stiffness, 3, 1e-15);
  for (const LocalFactors& f : {at(pi, 2e-3 + half), at(pi, 2e-3 - half), at(pi - half / mid_radius, 2e-3),
                                at(half / mid_radius - pi, 2e-3)}) {
    EXPECT_NEAR(f.critical_stretch, 0.7, 1e-12);
    EXPECT_NEAR(f.stiffness, 2, 1e-12);
  }
  EXPECT_EQ(at(pi, 2e-3 + 2.0001 * half).critical_stretch, 1);
  EXPECT_EQ(at(0, 2e-3).stiffness, 1);
}

TEST(Spots, TheWallBreaksFirstWhereItIsWeak) {
  const auto first_damage = [](const Parameters& p) {
    BodySetup setup = test::setup_of(p, 5e-7);
    const auto body = make_body(std::move(setup), test::self());
    int steps = 0;
    while (body->advance(600.0 * steps, 600.0 * (steps + 1)).broken == 0 && steps < 2000) ++steps;
    const Observation& seen = body->observe(600.0 * steps);
    double farthest = 0;
    for_each_particle(*body, [&](std::size_t i, const auto& x, std::size_t) {
      if (seen.damage[i] > 0) farthest = std::max(farthest, distance(x));
    });
    return std::pair(steps, farthest);
  };
  const auto [steps_uniform, far_uniform] = first_damage(spotted(1, 1, 1));
  EXPECT_GT(far_uniform, 3e-3);
  for (const auto& p : {spotted(0.5, 1, 1), spotted(1, 1, 0.6)}) {
    const auto [steps, far] = first_damage(p);
    EXPECT_LT(steps, steps_uniform);
    EXPECT_LT(far, 1.4e-3);  // a bond reaches a horizon farther than the spot
  }
}

TEST(Spots, ReachAcrossTheSeamOfPeriodicEnds) {
  Parameters p = spotted(0.4, 1, 0.5);
  p.spots.list[0].position = 0.1e-3;
  resolve(p);
  const double angle = std::numbers::pi;
  EXPECT_NEAR(p.spots.nearness(p.spots.list[0], mid_radius, angle, 3.8e-3),
              p.spots.nearness(p.spots.list[0], mid_radius, angle, 0.4e-3), 1e-12);
  EXPECT_GT(p.spots.nearness(p.spots.list[0], mid_radius, angle, 3.8e-3), 0.7);
  p.ends = EndCondition::free;
  resolve(p);
  EXPECT_EQ(p.spots.nearness(p.spots.list[0], mid_radius, angle, 3.8e-3), 0);
}

class ThinSpot : public testing::TestWithParam<const char*> {
 protected:
  Parameters parameters(double thickness) const {
    Parameters p = spotted(1, 1, thickness);
    p.cross_section = value_of<Arrangement>(GetParam()).value();
    return p;
  }
};
INSTANTIATE_TEST_SUITE_P(CrossSections, ThinSpot, testing::Values("lattice", "polar"),
                         [](const auto& i) { return std::string(i.param); });

TEST_P(ThinSpot, ItsOuterPartIsMissing) {
  const Parameters p = parameters(0.4);
  const BodySetup setup = test::setup_of(p, 1e-7);
  const Lattice& lattice = setup.lattice;
  const auto body = make_body(setup, test::self());
  const Observation& seen = body->observe(0);
  std::vector<bool> here;
  std::int64_t absent = 0;
  for_each_particle(*body, [&](std::size_t i, const auto& x, std::size_t) {
    const double near = 0.5 * (1 + std::cos(std::numbers::pi * std::min(1.0, distance(x) / 1e-3)));
    here.push_back(std::hypot(x[0], x[1]) < 1.5e-3 + (1 - 0.6 * near) * 0.5e-3 + 1e-9);
    absent += here[i] ? 0 : 1;
    EXPECT_EQ(std::isnan(seen.damage[i]), !here[i]);
  });
  EXPECT_GT(absent, 100);
  EXPECT_EQ(setup.thin_spots.absent(), absent);
  std::int64_t bonds = 0;
  for (std::size_t c = 0; c < lattice.section.size(); ++c) {
    for (std::int64_t r = 0; r < lattice.rows; ++r) {
      for (std::int64_t b = setup.families->first[c]; b < setup.families->first[c + 1]; ++b) {
        const Bond& bond = setup.families->bonds[b];
        const std::int64_t other = r + bond.row_offset;
        const std::int64_t wrapped = (other + lattice.rows) % lattice.rows;
        bonds += here[c * lattice.rows + r] && here[bond.other * lattice.rows + wrapped] ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(body->bonds(), bonds / 2);
  EXPECT_EQ(body->totals().broken_bonds, 0);
  EXPECT_EQ(body->totals().max_damage, 0);
}

TEST_P(ThinSpot, WhatIsLeftBearsTheWholePressure) {
  // The layer is a horizon thick, 0.35 mm; a wall of 0.2 mm leaves part of it.
  const BodySetup setup = test::setup_of(parameters(0.4), 1e-7);
  const auto body = make_body(setup, test::self());
  const double pressure = 1000;
  const Observation& seen = body->observe(pressure);
  double resultant = 0, along_x = 0, largest = 0;
  for_each_particle(*body, [&](std::size_t i, const auto&, std::size_t c) {
    const double force = std::hypot(seen.force_density[0][i], seen.force_density[1][i]);
    resultant += force * setup.lattice.volume(c);
    along_x += seen.force_density[0][i] * setup.lattice.volume(c);
    largest = std::max(largest, force);
    EXPECT_TRUE(force == 0 || !std::isnan(seen.damage[i]));
  });
  const double exact = pressure * 2 * std::numbers::pi * 1.5e-3 * 4e-3;
  EXPECT_NEAR(resultant / exact, 1, 1e-12);
  EXPECT_NEAR(along_x / exact, 0, 1e-3) << "the load stays where the pressure is";
  EXPECT_GT(largest / std::hypot(setup.layer.bx[0], setup.layer.by[0]) / pressure, 1.5);
}

TEST_P(ThinSpot, IsNoOpening) {
  BodySetup setup = test::setup_of(parameters(0.25), 1e-7);
  const Lattice lattice = setup.lattice;
  const ThinSpots thin = setup.thin_spots;
  const auto body = make_body(std::move(setup), test::self());
  const OpeningGauge gauge(lattice, *body, test::self(), EndCondition::axial_periodic, thin);
  EXPECT_EQ(gauge.area(), 0);
  const auto rest = test::sample(*body, test::nothing);
  body->set_state(test::sample(*body, [](auto x) { return std::array{0.2 * x[0], 0.2 * x[1], 0.0}; }), rest);
  EXPECT_EQ(gauge.area(), 0) << "widened evenly";
  // The part within 0.3 mm of the spot's centre bursts out: a hole, though absent particles are in front of
  // it.
  body->set_state(test::sample(*body,
                               [](auto x) {
                                 const double out = distance(x) < 3e-4 ? 5.0 : 0.0;
                                 return std::array{0.0, out * x[0], out * x[2]};
                               }),
                  rest);
  EXPECT_GT(gauge.area(), 1e-7);
}

TEST_P(ThinSpot, WorkOfThePressureBecomesEnergy) {
  Parameters p = parameters(0.4);
  p.length = 3e-3;
  BodySetup setup = test::setup_of(p, 1e-7);
  setup.time_step = 0.1 * test::stable_step_of(setup);
  const auto body = make_body(std::move(setup), test::self());
  for (int i = 0; i < 200; ++i) body->advance(200.0 * i, 200.0 * (i + 1));
  body->observe(200.0 * 200);
  const Totals t = body->totals();
  EXPECT_GT(t.external_work, 0);
  EXPECT_NEAR((t.kinetic + t.strain) / t.external_work, 1, 1e-3);
}

TEST(Spots, RefusesWhatIsNoSpot) {
  const auto key = [](const Parameters& given) {
    Parameters p = given;
    try {
      resolve(p);
    } catch (const InputError& error) {
      return error.key;
    }
    return std::string("none");
  };
  EXPECT_EQ(key(spotted(0.5, 2, 0.5)), "none");
  EXPECT_EQ(key(spotted(1, 1, 0.19)), "spot[1].thickness");
  Parameters far = spotted(0.5, 1, 1);
  far.spots.list[0].position = 4.1e-3;
  EXPECT_EQ(key(far), "spot[1].position");
  Parameters unloaded = spotted(1, 1, 0.5);
  unloaded.layer = LayerForce::paper;
  EXPECT_EQ(resolve(unloaded).size(), 1U);
  Parameters small = spotted(0.5, 1, 1);
  small.spots.list[0].radius = 1.9e-4;
  EXPECT_EQ(resolve(small).size(), 1U);
}

}  // namespace
}  // namespace rhexis::peridynamics
