// SPDX-License-Identifier: BSD-3-Clause
/// How long a time step linear bonds allow.
#pragma once

#include "peridynamics/bonds/bond_family.hpp"

namespace rhexis::peridynamics {

/// Stable time step of velocity Verlet for bonds of stiffness c/|xi|, s: dt = sqrt(2 rho / max_i lambda_i).
///
/// With n = xi/|xi| and k_ij = w_ij c V_j / |xi_ij|, the energy of a displacement u is at most
/// sum_ij V_i k_ij (n.u_i)^2, so squared frequencies are at most 2/rho times the largest eigenvalue of any
/// particle's sum_j k_ij n n^T: a third of its trace in the bulk. As the wall stretches, bonds turn towards
/// the direction of the stretch: uniaxial stretch s raises the eigenvalue by 1 + s (27 % at s = 0.25, by
/// integration over directions, tension of the bonds included), so lambda_i is (1 + s0) times it, and at most
/// the trace, for all bonds in one direction (Silling & Askari 2005, Eq. 36). `bond_constant` in N/m6,
/// `density` in kg/m3.
double stable_bond_step(const Lattice& lattice, const BondFamilies& families, double bond_constant,
                        double density, double critical_stretch);

}  // namespace rhexis::peridynamics
