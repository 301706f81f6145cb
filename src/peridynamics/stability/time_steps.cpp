// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/stability/time_steps.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.hpp"
#include "core/format.hpp"
#include "peridynamics/geometry/heterogeneity.hpp"
#include "peridynamics/laws/all_laws.hpp"
#include "peridynamics/stability/bond_step.hpp"
#include "peridynamics/stability/dilatation_bound.hpp"
#include "peridynamics/stability/linear_limit.hpp"

namespace rhexis::peridynamics {

double stable_time_step(const BodySetup& setup) {
  const Lattice& lattice = setup.lattice;
  return with_law(setup.law, [&]<class Law>(const Law& law) {
    const LocalFactors largest = setup.heterogeneity.largest(lattice);
    const double critical_stretch = setup.critical_stretch * largest.critical_stretch;
    const double of_bonds =
        stable_bond_step(lattice, *setup.families, setup.bond_constant, setup.density, critical_stretch) /
        std::sqrt(largest.stiffness * law.stiffness_ratio(critical_stretch));
    if constexpr (!Law::state_based) {
      return of_bonds;
    } else {
      if (law.kappa() <= 0) return of_bonds;  // dilatation makes it softer
      // Squared frequencies of stretches, (2 / of_bonds)^2, and of dilatations add up at most.
      const bool periodic = setup.ends == EndCondition::axial_periodic;
      const double energy =
          setup.bond_constant * law.weighted_volume(lattice.horizon) * law.dilatation_energy(1);
      const double squared = 2 * energy * largest.stiffness *
                             dilatation_bound(lattice, *setup.families, periodic) /
                             (setup.density * lattice.spacing * lattice.spacing);
      return of_bonds / std::sqrt(1 + squared * of_bonds * of_bonds / 4);
    }
  });
}

double stable_time_step(const Parameters& p, const BodySetup& tube) {
  return linear_time_step_limit(p, tube) / allowance_for_stretch(p);
}

TimeSteps time_steps(const Parameters& p, double stable) {
  TimeSteps t;
  t.stable = stable;
  t.step = p.time_step.value_or(p.step_fraction * t.stable);
  if (t.step > t.stable && !p.allow_unstable) {
    throw InputError("the run would be unstable; the largest stable time step of this discretisation is " +
                         quantity(0.9995 * t.stable, "s", 3) + "; take less, or \"auto\" for " +
                         quantity(p.step_fraction * t.stable, "s"),
                     "time.step");
  }
  const double steps = p.end_time / t.step;
  if (steps > 1e12) throw InputError("the run would take " + text(steps) + " steps", "time.end");
  t.count = std::max(1L, static_cast<long>(std::ceil(steps - 1e-6)));
  if (!p.time_step) t.step = p.end_time / static_cast<double>(t.count);
  return t;
}

}  // namespace rhexis::peridynamics
