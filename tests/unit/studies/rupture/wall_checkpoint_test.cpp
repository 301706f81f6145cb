// SPDX-License-Identifier: BSD-3-Clause
#include "studies/rupture/wall_checkpoint.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "peridynamics/simulation/time_loop.hpp"
#include "support/weak_vessel.hpp"
#include "unit/output/temporary_directory.hpp"

namespace rhexis::studies {
namespace {

const parallel::Communicator world = parallel::Communicator::world();

void run(peridynamics::VesselSimulation& simulation, const peridynamics::LoopPlan& plan) {
  peridynamics::LoadSource load;
  peridynamics::TimeLoop(simulation, load, plan).run();
}

TEST(WallCheckpoint, AWallGoesOnBitByBit) {
  const test::TemporaryDirectory directory;
  const std::filesystem::path path = directory / "wall.h5";
  test::MadeVessel made, continued;
  run(made.simulation, {.steps = 1000, .ends_at_rupture = true});
  const long step = made.simulation.step_number();
  made.simulation.load().share = 0.75;
  {
    output::CheckpointWriter file(path, "1.2.3", world);
    save_wall(made.simulation, {.turbulence = true}, file);
    file.close();
  }
  output::CheckpointReader file(path, world);
  GivenWarnings given{.crushed_bonds = true};
  restore_wall(continued.simulation, peridynamics::LoadSource(), given, step, file);
  EXPECT_FALSE(given.crushed_bonds);
  EXPECT_TRUE(given.turbulence);
  EXPECT_EQ(continued.simulation.step_number(), step);
  EXPECT_EQ(continued.simulation.pressure(), made.simulation.pressure());
  ASSERT_TRUE(made.simulation.rupture().onset);
  EXPECT_EQ(continued.simulation.rupture().onset, made.simulation.rupture().onset);
  made.simulation.load().next_share = 0.75;
  for (peridynamics::VesselSimulation* simulation : {&made.simulation, &continued.simulation})
    run(*simulation, {.steps = step + 20});
  EXPECT_EQ(continued.simulation.body().save().displacement, made.simulation.body().save().displacement);
  EXPECT_EQ(continued.simulation.totals().fracture, made.simulation.totals().fracture);
  EXPECT_EQ(continued.simulation.totals().external_work, made.simulation.totals().external_work);
}

TEST(WallCheckpoint, RefusesAShareThatTheLoadCannotHave) {
  const test::TemporaryDirectory directory;
  const std::filesystem::path path = directory / "wall.h5";
  test::MadeVessel made;
  made.simulation.load().share = 1.5;
  {
    output::CheckpointWriter file(path, "1.2.3", world);
    save_wall(made.simulation, {}, file);
    file.close();
  }
  output::CheckpointReader file(path, world);
  GivenWarnings given;
  EXPECT_THROW(restore_wall(made.simulation, peridynamics::LoadSource(), given, 0, file), InputError);
}

}  // namespace
}  // namespace rhexis::studies
