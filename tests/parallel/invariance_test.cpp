// SPDX-License-Identifier: BSD-3-Clause
// The same broken bonds and bit-identical positions, energies and openings for any number of ranks and
// threads. Each rank computes the reference by itself, on one thread; then all of them compute together, on
// two.
#include <gtest/gtest.h>
#include <omp.h>

#include "peridynamics/loads/venting.hpp"
#include "peridynamics/monitors/opening.hpp"
#include "peridynamics/statics/equilibrium.hpp"
#include "support/vessels.hpp"

namespace rhexis::peridynamics {
namespace {

struct Case {
  const char* name;
  const char* cross_section;
  const char* ends;
  const char* precision;
  double length;
  double scatter = 0;
  const char* law = "pmb";
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

class Invariance : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(
    Vessels, Invariance,
    testing::Values(Case{"Clamped", "lattice", "clamped", "single", 3.7e-3},
                    Case{"Short", "lattice", "free", "single", 1e-3},
                    Case{"Periodic", "polar", "axial_periodic", "single", 3.3e-3},
                    Case{"Double", "polar", "sliding", "double", 2e-3},
                    Case{"Scattered", "lattice", "clamped", "single", 3.7e-3, 0.1},
                    Case{"ScatteredPeriodic", "polar", "axial_periodic", "double", 3.3e-3, 0.1},
                    Case{"Fung", "lattice", "free", "single", 2e-3, 0.1, "fung"},
                    Case{"Lps", "polar", "clamped", "single", 3.7e-3, 0, "lps"},
                    Case{"LpsPeriodic", "lattice", "axial_periodic", "double", 3.3e-3, 0.1, "lps"}),
    [](const auto& i) { return i.param.name; });

Parameters parameters(const Case& c) {
  Parameters p = test::paper_vessel(c.length);
  p.cross_section = value_of<Arrangement>(c.cross_section).value();
  p.ends = value_of<EndCondition>(c.ends).value();
  p.bond_precision = value_of<Precision>(c.precision).value();
  p.critical_stretch = 0.1;
  p.scatter.critical_stretch = c.scatter;
  p.scatter.stiffness = c.scatter;
  if (c.scatter > 0)
    p.spots.list = {
        {.position = 2e-3, .angle = 0.5, .radius = 1e-3, .critical_stretch = 0.9, .thickness = 0.5}};
  p.law.name = c.law;
  if (p.law.name == "fung") p.law.numbers["fung_exponent"] = 10;
  if (p.law.name == "lps") p.law.poisson_ratio = 0.4;
  return p;
}

/// Loads hard enough to tear the wall; venting couples every rank to every other.
struct Outcome {
  std::unique_ptr<Body> body;
  Observation seen;
  Totals totals;
  double opening = 0;
};

Outcome outcome(const Case& c, parallel::Communicator comm, int threads) {
  omp_set_num_threads(threads);
  BodySetup setup = test::setup_of(parameters(c), 1e-6);
  const Lattice lattice = setup.lattice;
  const ThinSpots thin_spots = setup.thin_spots;
  Outcome o;
  o.body = make_body(std::move(setup), comm);
  const OpeningGauge gauge(lattice, *o.body, comm, parameters(c).ends, thin_spots);
  double pressure = 120e3;
  for (int i = 0; i < 150; ++i) {
    if (i % 10 == 0) pressure = 120e3 * venting_factor(gauge.area(), 5e-7);
    o.body->advance(pressure, pressure);
  }
  o.seen = o.body->observe(pressure);
  o.totals = o.body->totals();
  o.opening = gauge.area();
  return o;
}

TEST_P(Invariance, BitIdentical) {
  const Outcome alone = outcome(GetParam(), test::self(), 1);
  const auto world = parallel::Communicator::world();
  const Outcome together =
      outcome(GetParam(), world, 2 + world.rank() % 2);  // ranks divide their parts unlike
  const ColumnLayout& mine = *together.body->columns();
  const ColumnLayout& whole = *alone.body->columns();
  EXPECT_GT(alone.totals.broken_bonds, 1000) << "the test must break something to mean anything";
  EXPECT_EQ(alone.totals.broken_bonds, together.totals.broken_bonds);
  EXPECT_EQ(alone.totals.crushed_bonds, together.totals.crushed_bonds);
  EXPECT_EQ(alone.totals.kinetic, together.totals.kinetic);
  EXPECT_EQ(alone.totals.strain, together.totals.strain);
  EXPECT_EQ(alone.totals.fracture, together.totals.fracture);
  EXPECT_EQ(alone.totals.external_work, together.totals.external_work);
  EXPECT_EQ(alone.totals.max_displacement, together.totals.max_displacement);
  EXPECT_EQ(alone.totals.rupture_length, together.totals.rupture_length);
  EXPECT_EQ(alone.opening, together.opening);
  for (std::int64_t c = 0; c < mine.column_count; ++c) {
    for (std::int64_t r = 0; r < mine.row_count; ++r) {
      const auto here = static_cast<std::size_t>(c * mine.row_count + r);
      const auto there = static_cast<std::size_t>((mine.first_column + c) * whole.rows + mine.first_row + r);
      for (int k = 0; k < 3; ++k) {
        ASSERT_EQ(together.body->displacement()[k][here], alone.body->displacement()[k][there]);
        ASSERT_EQ(together.seen.velocity[k][here], alone.seen.velocity[k][there]);
        ASSERT_EQ(together.seen.force_density[k][here], alone.seen.force_density[k][there]);
      }
      const double damage = together.seen.damage[here], expected = alone.seen.damage[there];
      ASSERT_TRUE(damage == expected || (std::isnan(damage) && std::isnan(expected)));
      ASSERT_EQ(together.seen.strain_energy_density[here], alone.seen.strain_energy_density[there]);
    }
  }
}

TEST_P(Invariance, EquilibriumIsBitIdentical) {
  Parameters p = parameters(GetParam());
  if (p.ends != EndCondition::clamped) p.spots = {};  // beside a thin spot nothing holds what pushes sideways
  const auto find = [&](parallel::Communicator comm, int threads) {
    omp_set_num_threads(threads);
    return find_equilibrium(test::setup_of(p, 1e-6), 30e3, 1e-3, comm);
  };
  const Equilibrium alone = find(test::self(), 1), together = find(parallel::Communicator::world(), 2);
  EXPECT_EQ(alone.steps, together.steps);
  EXPECT_EQ(alone.residual, together.residual);
  EXPECT_EQ(alone.strain_energy, together.strain_energy);
  const auto body = make_body(test::setup_of(p, 1e-6), parallel::Communicator::world());
  const ColumnLayout& mine = *body->columns();
  for (std::int64_t c = 0; c < mine.column_count; ++c) {
    for (std::int64_t r = 0; r < mine.row_count; ++r) {
      const auto here = static_cast<std::size_t>(c * mine.row_count + r);
      const auto there = static_cast<std::size_t>((mine.first_column + c) * mine.rows + mine.first_row + r);
      for (std::size_t k = 0; k < 3; ++k)
        ASSERT_EQ(together.displacement[k][here], alone.displacement[k][there]);
    }
  }
}

}  // namespace
}  // namespace rhexis::peridynamics
