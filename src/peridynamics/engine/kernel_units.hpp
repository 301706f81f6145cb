// SPDX-License-Identifier: BSD-3-Clause
/// From the units of the bond kernel to SI: the kernel measures lengths in spacings and sums forces and
/// energies for a bond constant of 1.
#pragma once

#include "peridynamics/geometry/cross_section.hpp"

namespace rhexis::peridynamics {

class KernelUnits {
 public:
  /// `bond_constant` c in N/m6. Keeps a pointer to `lattice`.
  KernelUnits(const Lattice& lattice, double bond_constant)
      : lattice_(&lattice),
        cubic_spacing_(lattice.spacing * lattice.spacing * lattice.spacing),
        energy_density_(bond_constant * cubic_spacing_ * lattice.spacing) {}

  /// spacing^3, m3.
  double volume() const { return cubic_spacing_; }
  /// c spacing^4, J/m3.
  double energy_density() const { return energy_density_; }
  /// Volume of a particle of `column`, in spacings cubed.
  double relative_volume(std::size_t column) const { return lattice_->volume(column) / cubic_spacing_; }
  /// Force density (N/m3) on a particle of `column` whose bonds sum to 1.
  double force_density(std::size_t column) const {
    return energy_density_ / (lattice_->spacing * relative_volume(column));
  }

 private:
  const Lattice* lattice_;
  double cubic_spacing_, energy_density_;
};

}  // namespace rhexis::peridynamics
