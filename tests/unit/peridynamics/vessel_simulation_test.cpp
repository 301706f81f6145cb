// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/simulation/vessel_simulation.hpp"

#include <gtest/gtest.h>

#include "peridynamics/bonds/surface_correction.hpp"
#include "peridynamics/stability/time_steps.hpp"
#include "support/vessels.hpp"

namespace rhexis::peridynamics {
namespace {

/// A short piece of the paper's wall, weak and coarse, under 60 kPa: it ruptures within 0.5 ms.
Parameters weak_vessel() {
  Parameters v = test::paper_vessel(1e-3);
  v.spacing = 1.6e-4;
  v.horizon = 5.6e-4;
  v.critical_stretch = 0.02;
  v.ends = EndCondition::axial_periodic;
  v.length = 1.6e-3;
  v.schedule = Schedule::smooth_ramp;
  v.end_time = 5e-4;
  v.step_fraction = 0.65;
  v.pressure = 60e3;
  resolve(v);
  return v;
}

struct Made {
  SharedWall wall = make_wall(weak_vessel());
  VesselSimulation simulation{*wall, parallel::Communicator::world()};
};

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
  Made made;
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

TEST(VesselSimulation, PassesTheFlagsOfItsCallerOn) {
  Made made;
  LoadSource load;
  EXPECT_EQ(made.simulation.step(load, 4).flags, 4u);
  EXPECT_EQ(made.simulation.step(load).flags, 0u);
}

TEST(VesselSimulation, TheLoadsShareActsFromTheNextStepOn) {
  struct Half : LoadSource {
    void before_step(VesselSimulation& s) override { s.load().next_share = 0.5; }
  };
  Made made;
  Half load;
  made.simulation.resume(100, {}, {});
  EXPECT_EQ(made.simulation.pressure(), made.simulation.scheduled_pressure_at(100));
  made.simulation.step(load);
  EXPECT_EQ(made.simulation.pressure(), 0.5 * made.simulation.scheduled_pressure_at(101));
}

TEST(VentedLoad, LeavesAnIntactWallAlone) {
  Made made;
  VentedLoad load(1e-6);
  for (int i = 0; i < 30; ++i) made.simulation.step(load);
  EXPECT_EQ(made.simulation.load().share, 1);
  EXPECT_EQ(made.simulation.load().least_share, 1);
}

TEST(VentedLoad, FallsByTheOpeningOfARupturedWall) {
  Made made;
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
