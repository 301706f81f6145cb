// SPDX-License-Identifier: BSD-3-Clause
/// The gradient of a field that is known at particles, from its differences along bonds.
///
/// With weights w of bonds and moments K_i = sum_j w_ij V_j xi (x) xi the gradient by moments,
///
///   H_i = sum_j (u_j - u_i) (x) G_ij,   G_ij = w_ij V_j K_i^-1 xi,
///
/// is exact for linear fields up to the surface (Silling et al. 2007; Bessa et al. 2014). Where particles lie
/// irregularly, nodal sums of such gradients do not integrate by parts: a homogeneous stress would push
/// particles inside a body. The smallest change of G, measured by |dG_ij|^2 / (w_ij V_j), that keeps linear
/// fields exact and makes
///
///   sum_i V_i dH_i / du_k = b_k,
///
/// with b_k the area (as a vector) of the surface that moves with particle k, by the displacement that the
/// gradient by moments extrapolates to the surface, and 0 inside, has the form
///
///   G_ij = w_ij V_j (B_i xi + V_i (m_j - m_i)),   B_i = (I - V_i sum_j w_ij V_j (m_j - m_i) (x) xi) K_i^-1,
///
/// m_k being the Lagrange multiplier (a vector) of particle k's condition (the idea is Chen, Hillman & Ruter
/// 2013, Int. J. Numer. Meth. Eng. 95, 387-418). When bonds break, B_i is found anew from those that are
/// left.
#pragma once

#include <vector>

#include "peridynamics/bonds/neighbours.hpp"

namespace rhexis::peridynamics {

/// A cubic spline of a bond's length over the horizon, 1 to 0, and a thousandth more: bonds at the horizon's
/// edge keep families in three dimensions. `ratio`: |xi| / horizon.
double influence(double ratio);

/// What gradients of a body need; lengths in spacings.
struct GradientWeights {
  std::vector<double> weight;       ///< [bonds] w_ij V_j
  std::vector<Vector3> multiplier;  ///< [particles] m
  int iterations = 0;               ///< of conjugate gradients, in all
  double imbalance = 0;  ///< largest |sum_i V_i dH_i/du_k - b_k| left, in units of the spacing squared
};

/// Solves for the multipliers, by conjugate gradients until the residual has fallen by `tolerance`. The
/// result does not depend on the number of threads.
GradientWeights find_gradient_weights(const ParticleSet& set, const Neighbours& neighbours, double horizon,
                                      double tolerance = 1e-8);

}  // namespace rhexis::peridynamics
