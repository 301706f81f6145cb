// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/loads/pressure_layer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"

namespace rhexis::peridynamics {

PressureLayer make_pressure_layer(const Parameters& p, const Lattice& lattice) {
  const CrossSection& s = lattice.section;
  const double inner = p.inner_radius - 1e-9 * lattice.spacing;
  const double outer = p.inner_radius + *p.layer_thickness + 1e-9 * lattice.spacing;
  PressureLayer layer{std::vector<double>(s.size()), std::vector<double>(s.size())};
  double resultant = 0;  // per length and unit of pressure
  for (std::size_t c = 0; c < s.size(); ++c) {
    const double r = std::hypot(s.x[c], s.y[c]);
    if (r < inner || r > outer) continue;
    const double depth = (r - p.inner_radius) / *p.layer_thickness;
    const double share =
        p.layer == LayerForce::nonlocal ? std::max(0.0, 1 - depth * depth * depth * (4 - 3 * depth)) : 1.0;
    layer.bx[c] = share * s.x[c] / r;
    layer.by[c] = share * s.y[c] / r;
    resultant += share * s.area[c];
  }
  if (resultant == 0) {
    throw InputError("no particle lies in the loaded layer; make it at least one spacing thick",
                     "load.layer_thickness");
  }
  const double magnitude = p.layer == LayerForce::paper ? 1 / *p.layer_thickness
                                                        : 2 * std::numbers::pi * p.inner_radius / resultant;
  for (std::size_t c = 0; c < s.size(); ++c) {
    layer.bx[c] *= magnitude;
    layer.by[c] *= magnitude;
  }
  return layer;
}

}  // namespace rhexis::peridynamics
