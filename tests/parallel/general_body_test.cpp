// SPDX-License-Identifier: BSD-3-Clause
/// The general engine on several ranks and threads: the same digits, the energy balance, restarts.
#include "peridynamics/engine/general_body.hpp"

#include <gtest/gtest.h>
#include <omp.h>

namespace rhexis::peridynamics {
namespace {

constexpr double spacing = 1e-4;

/// A short tube that bursts: what is left after `steps` steps.
std::unique_ptr<Body> burst(parallel::Communicator comm, int steps) {
  Lattice lattice;
  lattice.section = polar_cross_section(6e-4, 9e-4, spacing);
  lattice.rows = 12;
  lattice.row_spacing = lattice.spacing = spacing;
  auto setup = std::make_shared<GeneralSetup>();
  setup->geometry = make_geometry(tube_particles(lattice), 2.2 * spacing);
  setup->law = NeoHookean(3.5e6, 0.4);
  setup->density = 1300;
  setup->critical_stretch = 0.1;
  setup->time_step = 1e-7;
  setup->energy_scale = 1e-3;
  auto body = make_body(setup, comm);
  for (int i = 0; i < steps; ++i) body->advance(1e6, 1e6);
  body->observe(1e6);
  return body;
}

TEST(GeneralBodyOnRanks, GivesTheSameDigitsForAnyRanksAndThreads) {
  constexpr int steps = 250;
  const auto world = parallel::Communicator::world();
  const auto shared = burst(world, steps);
  const Totals totals = shared->totals();
  EXPECT_GT(totals.broken_bonds, 100);
  const int threads = omp_get_max_threads();
  omp_set_num_threads(threads == 1 ? 2 : 1);
  const auto alone = burst(parallel::Communicator::self(), steps);
  omp_set_num_threads(threads);
  const auto first = static_cast<std::size_t>(shared->ids().ranges.front().first);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < shared->displacement()[k].size(); ++i)
      ASSERT_EQ(shared->displacement()[k][i], alone->displacement()[k][first + i]);
  }
  const Totals same = alone->totals();
  EXPECT_EQ(totals.strain, same.strain);
  EXPECT_EQ(totals.kinetic, same.kinetic);
  EXPECT_EQ(totals.fracture, same.fracture);
  EXPECT_EQ(totals.external_work, same.external_work);
  EXPECT_EQ(totals.broken_bonds, same.broken_bonds);
  EXPECT_EQ(totals.rupture_length, same.rupture_length);
}

TEST(GeneralBodyOnRanks, EnergyBalancesThroughRupture) {
  const auto world = parallel::Communicator::world();
  // While the tube is torn to shreds the balance is of first order in the step.
  for (const auto& [steps, tolerance] : {std::pair{100, 1e-3}, std::pair{250, 5e-3}}) {
    const Totals t = burst(world, steps)->totals();
    EXPECT_NEAR(t.kinetic + t.strain + t.fracture, t.external_work, tolerance * t.external_work) << steps;
  }
}

TEST(GeneralBodyOnRanks, GoesOnFromASavedState) {
  const auto world = parallel::Communicator::world();
  const auto whole = burst(world, 250);
  const auto part = burst(world, 200), rest = burst(world, 0);
  part->advance(1e6, 1e6);
  rest->restore(part->save());
  for (int i = 201; i < 250; ++i) rest->advance(1e6, 1e6);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < whole->displacement()[k].size(); ++i)
      ASSERT_EQ(whole->displacement()[k][i], rest->displacement()[k][i]);
  }
  whole->observe(1e6);
  rest->observe(1e6);
  EXPECT_EQ(whole->totals().external_work, rest->totals().external_work);
  EXPECT_EQ(whole->totals().fracture, rest->totals().fracture);
}

}  // namespace
}  // namespace rhexis::peridynamics
