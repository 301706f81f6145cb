// SPDX-License-Identifier: BSD-3-Clause
/// Where velocity Verlet really begins to be unstable, while strains are small.
#pragma once

#include "peridynamics/wall_model.hpp"

namespace rhexis::peridynamics {

/// The longest stable time step (s) of small vibrations, 2 / omega_max, to about 0.1 %. `stable_time_step` is
/// a bound below it, found without solving for anything. omega_max is the highest frequency of a periodic
/// piece of the wall, by Lanczos' method on the engine's own forces: the free ends of a vessel only take
/// stiffness away. Works alone, on the calling rank.
double linear_time_step_limit(const BodySetup& setup);

/// The same of a law by gradient, of a short piece of the tube.
double linear_time_step_limit(const Parameters& p, const BodySetup& tube);

/// By how much the stable step of a law by gradient is less: 1 + s0, since cells that are stretched by s0 are
/// as much narrower across, times the root of how much fibres stiffen up to s0.
double allowance_for_stretch(const Parameters& p);

/// The same of a wall of any law.
double linear_time_step_limit(const WallModel& wall);

/// Memory that finding it takes.
double linear_limit_bytes(const Parameters& p, const WallSize& size);

}  // namespace rhexis::peridynamics
