/// The time steps of a run: how long, how many.
#pragma once

#include "peridynamics/bond_family.hpp"

namespace rhexis::peridynamics {

struct TimeSteps {
  double stable = 0;  ///< s, the longest stable step
  double step = 0;    ///< s, the one to take
  long count = 0;     ///< of them until time.end, the last one whole
};

/// s, of the material's law; for bonds compressed no more than those that break are stretched.
double stable_time_step(const Parameters& p, const Lattice& lattice, const BondFamilies& families);

/// The user's step, or a share of the stable one that divides the end time evenly. Throws InputError for a
/// step that is unstable, or for far too many.
TimeSteps time_steps(const Parameters& p, const Lattice& lattice, const BondFamilies& families);

}  // namespace rhexis::peridynamics
