// SPDX-License-Identifier: BSD-3-Clause
/// How stiff dilatation can make a body: what the stable time step of a state-based law depends on.
#pragma once

#include "peridynamics/bonds/bond_family.hpp"

namespace rhexis::peridynamics {

/// A bound C of sum_i V_i theta_i^2 <= C sum_i V_i |u_i|^2 for small displacements u in spacings, theta as in
/// laws/lps.hpp.
///
/// With a_ij = 3 w_ij V_j / m, theta_i = sum_j a_ij n_ij . (u_j - u_i) = sum_j a_ij n_ij . u_j - d_i . u_i.
/// Cauchy and Schwarz give, with R_i = sum_j a_ij + |d_i|,
///   theta_i^2 <= R_i (sum_j a_ij (n_ij . u_j)^2 + (d_i . u_i)^2 / |d_i|),
/// and the sum over i is one over j of V_j u_j . M_j u_j with
///   M_j = sum_i a_ji R_i n_ij n_ij^T + R_j d_j d_j^T / |d_j|.
/// C is the largest sum of magnitudes in a row of any M_j; no eigenvalue is above it.
double dilatation_bound(const Lattice& lattice, const BondFamilies& families, bool periodic);

}  // namespace rhexis::peridynamics
