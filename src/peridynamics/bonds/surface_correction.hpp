// SPDX-License-Identifier: BSD-3-Clause
/// Surface corrections: weights of bonds that make up for the neighbours that particles near the wall's two
/// surfaces lack, and for the coarseness of the sums that stand for integrals.
///
/// A bond's weight multiplies its force and its energy. It is the same seen from both ends, so action equals
/// reaction. Families are those of an endless vessel: the axial ends are not corrected.
#pragma once

#include "peridynamics/bonds/bond_family.hpp"

namespace rhexis::peridynamics {

/// "auto" resolved: "calibrated" on a polar cross-section, "none" on a lattice, for every law. (Calibrated
/// weights know nothing of dilatation, but state-based walls gain by them too: see lps_lame_test.cpp.)
SurfaceCorrection surface_correction(const Parameters& p);

/// Eq. (1)'s families with the weights that `p.surface_correction` asks for:
///
/// - "none": 1.
/// - "volume": 2 V0 / (V_i + V_j), V the volume of a family, V0 that of a whole one (Le & Bobaru 2018,
/// Comput.
///   Mech. 61:499).
/// - "energy": families match the elastic energy of a stretch along the local radial, hoop and axial
/// direction
///   (Madenci & Oterkus 2014, Peridynamic Theory and Its Applications, Sec. 4.2).
/// - "calibrated": the smallest change of weights for which the wall as a whole holds exactly the elastic
/// energy
///   of every homogeneous strain in the local frame, and each ring holds it as nearly as that allows; no
///   weight falls below `least_weight`. After the idea of fitting micromoduli to the stiffness tensor by
///   least squares (Prakash 2018). Polar cross-sections only.
BondFamilies weighted_families(const Parameters& p, const Lattice& lattice);
SharedFamilies shared_families(const Parameters& p, const Lattice& lattice);

inline constexpr double least_weight = 0.3;

/// Memory that finding the weights takes beside the families: of "calibrated" ones the conditions, at first,
/// and their dense matrix with its factors; of others none.
double weighting_bytes(const Parameters& p, const WallSize& size);

}  // namespace rhexis::peridynamics
