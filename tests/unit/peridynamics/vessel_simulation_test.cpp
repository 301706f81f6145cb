// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/simulation/vessel_simulation.hpp"

#include <gtest/gtest.h>

#include "peridynamics/loads/venting.hpp"
#include "support/weak_vessel.hpp"

namespace rhexis::peridynamics {
namespace {

/// Steps until the onset of rupture.
void rupture(VesselSimulation& simulation, LoadSource& load) {
  for (bool ruptures = false; !ruptures;) {
    ASSERT_LT(simulation.time(), 5e-4);
    const auto report = simulation.step(load);
    ASSERT_FALSE(report.unstable);
    ruptures = report.ruptures;
  }
}

TEST(VesselSimulation, RecordsWhenTheWallBreaksAndUnderWhat) {
  test::MadeVessel made;
  VesselSimulation& simulation = made.simulation;
  LoadSource load;
  rupture(simulation, load);
  const RuptureEvents& events = simulation.rupture();
  ASSERT_TRUE(events.first_break && events.onset);
  EXPECT_LE(*events.first_break, *events.onset);
  // Events are of the moment before the step.
  const long before = simulation.step_number() - 1;
  EXPECT_EQ(*events.onset, simulation.time_at(before));
  EXPECT_EQ(*events.pressure, simulation.scheduled_pressure_at(before));
  EXPECT_LT(*events.blood_pressure, *events.pressure);  // the lumen has widened
  EXPECT_GT(*events.max_displacement, 0);
  // Later steps change nothing of it.
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(simulation.step(load).ruptures);
  EXPECT_EQ(*events.onset, simulation.time_at(before));
}

TEST(VesselSimulation, APressureThatFollowsTheWallIsABloodPressure) {
  Parameters p = test::weak_vessel();
  p.direction = LoadDirection::follower;
  const SharedWall wall = make_wall(p);
  VesselSimulation simulation(*wall, parallel::Communicator::world());
  LoadSource load;
  rupture(simulation, load);
  EXPECT_EQ(*simulation.rupture().blood_pressure, *simulation.rupture().pressure);
}

TEST(VesselSimulation, PassesTheFlagsOfItsCallerOn) {
  test::MadeVessel made;
  LoadSource load;
  EXPECT_EQ(made.simulation.step(load, 4).flags, 4u);
  EXPECT_EQ(made.simulation.step(load).flags, 0u);
}

TEST(VesselSimulation, TheLoadsShareActsFromTheNextStepOn) {
  struct Half : LoadSource {
    void before_step(VesselSimulation& s) override { s.load().next_share = 0.5; }
  };
  test::MadeVessel made;
  Half load;
  made.simulation.resume(100, {}, {});
  EXPECT_EQ(made.simulation.pressure(), made.simulation.scheduled_pressure_at(100));
  made.simulation.step(load);
  EXPECT_EQ(made.simulation.pressure(), 0.5 * made.simulation.scheduled_pressure_at(101));
}

TEST(VentedLoad, LeavesAnIntactWallAlone) {
  test::MadeVessel made;
  VentedLoad load(1e-6);
  for (int i = 0; i < 30; ++i) made.simulation.step(load);
  EXPECT_EQ(made.simulation.load().share, 1);
  EXPECT_EQ(made.simulation.load().least_share, 1);
}

TEST(VentedLoad, FallsByTheOpeningOfARupturedWall) {
  test::MadeVessel made;
  VentedLoad load(1e-6);
  rupture(made.simulation, load);
  while (made.simulation.load().least_share == 1 && made.simulation.time() < 5e-4)
    ASSERT_FALSE(made.simulation.step(load).unstable);
  const LoadState& state = made.simulation.load();
  ASSERT_GT(state.open_area, 0);
  EXPECT_EQ(state.share, venting_factor(state.open_area, 1e-6));
  EXPECT_EQ(state.least_share, state.share);
}

}  // namespace
}  // namespace rhexis::peridynamics
