#include "peridynamics/time_steps.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/format.hpp"
#include "peridynamics/dilatation_bound.hpp"
#include "peridynamics/heterogeneity.hpp"
#include "peridynamics/materials/with_law.hpp"

namespace rhexis::peridynamics {

double stable_time_step(const Parameters& p, const Lattice& lattice, const BondFamilies& families) {
  const WallFactors largest = Heterogeneity(p).largest(lattice);
  return with_law(p.law, [&]<class Law>(const Law& law) {
    const double bond_constant = law.bond_constant(p.young_modulus, *p.horizon);
    const double hardening = law.stiffness_ratio(p.critical_stretch * largest.critical_stretch);
    const double of_bonds = stable_time_step(lattice, families, bond_constant, p.density) /
                            std::sqrt(largest.stiffness * hardening);
    if constexpr (!Law::state_based) {
      return of_bonds;
    } else {
      if (law.kappa() <= 0) return of_bonds;  // dilatation makes it softer
      // Squared frequencies of stretches, (2 / of_bonds)^2, and of dilatations add up at most.
      const bool periodic = end_condition(p) == EndCondition::axial_periodic;
      const double energy = bond_constant * law.weighted_volume(*p.horizon) * law.dilatation_energy(1);
      const double squared = 2 * energy * largest.stiffness * dilatation_bound(lattice, families, periodic) /
                             (p.density * lattice.spacing * lattice.spacing);
      return of_bonds / std::sqrt(1 + squared * of_bonds * of_bonds / 4);
    }
  });
}

TimeSteps time_steps(const Parameters& p, const Lattice& lattice, const BondFamilies& families) {
  TimeSteps t;
  t.stable = stable_time_step(p, lattice, families);
  t.step = p.time_step.value_or(p.step_fraction * t.stable);
  if (t.step > t.stable) {
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
