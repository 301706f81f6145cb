// SPDX-License-Identifier: BSD-3-Clause
// The same broken bonds and bit-identical positions, energies and openings for any number of ranks and
// threads. The first rank computes the reference by itself, on one thread; then all of them compute together,
// on two and three.
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

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
  LoadDirection direction = LoadDirection::dead;
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
                    Case{"LpsPeriodic", "lattice", "axial_periodic", "double", 3.3e-3, 0.1, "lps"},
                    Case{"Follower", "polar", "clamped", "single", 3.7e-3, 0.1, "pmb",
                         LoadDirection::follower},
                    Case{"FollowerFree", "polar", "free", "single", 2e-3, 0, "pmb", LoadDirection::follower},
                    Case{"FollowerLattice", "lattice", "axial_periodic", "double", 3.3e-3, 0.1, "lps",
                         LoadDirection::follower}),
    [](const auto& i) { return i.param.name; });

Parameters parameters(const Case& c) {
  Parameters p = test::paper_vessel(c.length);
  p.cross_section = value_of<Arrangement>(c.cross_section).value();
  p.ends = value_of<EndCondition>(c.ends).value();
  p.bond_precision = value_of<Precision>(c.precision).value();
  p.critical_stretch = 0.1;
  p.direction = c.direction;
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

/// What all ranks know, and as many numbers of every particle, one particle after the other.
struct Numbers {
  std::vector<double> common, of_particles;
};

/// What the first rank makes, on all ranks.
Numbers of_first_rank(const std::function<Numbers()>& make, parallel::Communicator comm) {
  const auto broadcast = [&](const std::vector<double>& values) {
    const std::string bytes = comm.broadcast(
        std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)));
    std::vector<double> received(bytes.size() / sizeof(double));
    std::memcpy(received.data(), bytes.data(), bytes.size());
    return received;
  };
  const Numbers numbers = comm.is_root() ? make() : Numbers{};
  return {broadcast(numbers.common), broadcast(numbers.of_particles)};
}

/// Equal, or no number both.
bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

/// `mine`: of this rank's particles, in the order of `columns`.
void expect_same(const Numbers& mine, const Numbers& whole, const ColumnLayout& columns) {
  ASSERT_EQ(mine.common.size(), whole.common.size());
  for (std::size_t i = 0; i < mine.common.size(); ++i)
    EXPECT_TRUE(same(mine.common[i], whole.common[i])) << "common number " << i;
  const std::size_t per_particle = mine.of_particles.size() / static_cast<std::size_t>(columns.local_count());
  ASSERT_GT(per_particle, 0u);
  ASSERT_EQ(per_particle * static_cast<std::size_t>(columns.columns * columns.rows),
            whole.of_particles.size());
  for (std::int64_t c = 0; c < columns.column_count; ++c) {
    for (std::int64_t r = 0; r < columns.row_count; ++r) {
      const auto here = static_cast<std::size_t>(c * columns.row_count + r);
      const auto there =
          static_cast<std::size_t>((columns.first_column + c) * columns.rows + columns.first_row + r);
      for (std::size_t k = 0; k < per_particle; ++k)
        ASSERT_TRUE(
            same(mine.of_particles[here * per_particle + k], whole.of_particles[there * per_particle + k]))
            << "number " << k << " of particle " << there;
    }
  }
}

Numbers numbers_of(const Outcome& o) {
  const Totals& t = o.totals;
  Numbers all{{static_cast<double>(t.broken_bonds), static_cast<double>(t.crushed_bonds), t.kinetic, t.strain,
               t.fracture, t.external_work, t.max_displacement, t.rupture_length, o.opening},
              {}};
  for (std::size_t i = 0; i < o.seen.damage.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (const double value :
           {o.body->displacement()[k][i], o.seen.velocity[k][i], o.seen.force_density[k][i]})
        all.of_particles.push_back(value);
    }
    all.of_particles.push_back(o.seen.damage[i]);
    all.of_particles.push_back(o.seen.strain_energy_density[i]);
  }
  return all;
}

TEST_P(Invariance, BitIdentical) {
  const auto world = parallel::Communicator::world();
  const Numbers alone = of_first_rank([] { return numbers_of(outcome(GetParam(), test::self(), 1)); }, world);
  const Outcome together =
      outcome(GetParam(), world, 2 + world.rank() % 2);  // ranks divide their parts unlike
  EXPECT_GT(together.totals.broken_bonds, 1000) << "the test must break something to mean anything";
  expect_same(numbers_of(together), alone, *together.body->columns());
}

TEST_P(Invariance, EquilibriumIsBitIdentical) {
  Parameters p = parameters(GetParam());
  if (p.ends != EndCondition::clamped) p.spots = {};  // beside a thin spot nothing holds what pushes sideways
  const auto find = [&](parallel::Communicator comm, int threads) {
    omp_set_num_threads(threads);
    const Equilibrium found = find_equilibrium(test::setup_of(p, 1e-6), 30e3, 1e-3, comm);
    Numbers all{{static_cast<double>(found.steps), found.residual, found.strain_energy}, {}};
    for (std::size_t i = 0; i < found.displacement[0].size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) all.of_particles.push_back(found.displacement[k][i]);
    }
    return all;
  };
  const auto world = parallel::Communicator::world();
  const Numbers alone = of_first_rank([&] { return find(test::self(), 1); }, world);
  const auto body = make_body(test::setup_of(p, 1e-6), world);
  expect_same(find(world, 2), alone, *body->columns());
}

}  // namespace
}  // namespace rhexis::peridynamics
