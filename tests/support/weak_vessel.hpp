// SPDX-License-Identifier: BSD-3-Clause
/// A wall that ruptures soon, and its simulation.
#pragma once

#include "parallel/communicator.hpp"
#include "peridynamics/simulation/vessel_simulation.hpp"
#include "support/vessels.hpp"

namespace rhexis::test {

/// A short piece of the paper's wall, weak and coarse, under 60 kPa: it ruptures within 0.5 ms.
inline peridynamics::Parameters weak_vessel() {
  peridynamics::Parameters v = paper_vessel(1e-3);
  v.spacing = 1.6e-4;
  v.horizon = 5.6e-4;
  v.critical_stretch = 0.02;
  v.ends = peridynamics::EndCondition::axial_periodic;
  v.length = 1.6e-3;
  v.schedule = peridynamics::Schedule::smooth_ramp;
  v.end_time = 5e-4;
  v.step_fraction = 0.65;
  v.pressure = 60e3;
  resolve(v);
  return v;
}

struct MadeVessel {
  peridynamics::SharedWall wall = peridynamics::make_wall(weak_vessel());
  peridynamics::VesselSimulation simulation{*wall, parallel::Communicator::world()};
};

}  // namespace rhexis::test
