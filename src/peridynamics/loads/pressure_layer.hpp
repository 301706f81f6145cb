// SPDX-License-Identifier: BSD-3-Clause
/// Eq. (8): the net pressure as a body force in a layer at the lumen.
///
/// The paper's layer r0 - delta <= r <= r0 lies in the lumen, where the wall has no particle; here it is
/// r0 <= r <= r0 + thickness, inside the wall. The force is dead: it keeps its reference direction.
#pragma once

#include <vector>

#include "peridynamics/geometry/cross_section.hpp"

namespace rhexis::peridynamics {

/// Force density per unit of pressure on each column's particles: b = P (bx, by), 1/m; zero outside the
/// layer.
struct PressureLayer {
  std::vector<double> bx, by;

  bool loads(std::size_t column) const { return bx[column] != 0 || by[column] != 0; }
};

/// `layer` "paper": |b| = P / thickness. Of the others the resultant sum |b| V is exactly P 2 pi r0 L.
/// "consistent": |b| is the same over the layer. "nonlocal": at depth x (in thicknesses) |b| is in proportion
/// to 1 - 4 x^3 + 3 x^4, the pull on a particle of the bonds that a flat surface cuts from its family under
/// uniform strain along its normal: what stands in for them. Throws InputError where the layer
/// holds no particle.
PressureLayer make_pressure_layer(const Parameters& p, const Lattice& lattice);

}  // namespace rhexis::peridynamics
