// SPDX-License-Identifier: BSD-3-Clause
/// The time steps of a run: how long, how many.
#pragma once

#include "peridynamics/engine/body.hpp"

namespace rhexis::peridynamics {

/// `stable` bounds the stiffness of every bond by c/|xi| in all directions. Along a PMB bond that is its
/// stiffness at any strain; across it the stiffness is (c/|xi|) s/(1 + s), which is less while s > -1/2: so
/// the step holds at finite strain too, until bonds are crushed to half their length (Totals::crushed_bonds).
struct TimeSteps {
  double stable = 0;  ///< s, a bound below the longest stable step (see linear_limit.hpp)
  double step = 0;    ///< s, the one to take
  long count = 0;     ///< time steps until time.end, the last one whole
};

/// The stable time step (s) of the wall's law, by bond_step.hpp and dilatation_bound.hpp; for bonds that are
/// compressed no more than those that break are stretched. `setup.time_step` is not read.
double stable_time_step(const BodySetup& setup);

/// The same of a law by gradient: the limit of linear stability of a short piece of the tube, found by
/// Lanczos' method, over allowance_for_stretch (linear_limit.hpp).
double stable_time_step(const Parameters& p, const BodySetup& tube);

/// The user's step, or a share of the stable one that divides the end time evenly. Throws InputError for a
/// step that is unstable, or for far too many.
TimeSteps time_steps(const Parameters& p, double stable);

}  // namespace rhexis::peridynamics
