// SPDX-License-Identifier: BSD-3-Clause
/// Red cells at a bifurcation: they do not divide as blood does, the faster branch gets more than its share
/// (Pries & Secomb 2008, Microcirculation, in Handbook of Physiology; Pries et al. 1989, Microvasc Res
/// 38:81).
///
/// With diameters in um (parent Dp, daughters Da and Db), the parent's discharge haematocrit H and daughter
/// a's fraction of the blood flow f:
///   h = (1 - H) / Dp,  X0 = 0.964 h,  B = 1 + 6.98 h,  A = -13.29 h (q - 1) / (q + 1),  q = (Da / Db)^2
///   y = (f - X0) / (1 - 2 X0);  fraction of the cells = 1 / (1 + exp(-(A + B logit y))), 0 for y <= 0, 1 for
///   y >= 1.
#pragma once

#include <algorithm>
#include <cmath>

namespace rhexis::hemodynamics {

/// Fraction of the red cells that daughter a gets of a parent with `flow_fraction` going to a.
inline double red_cell_fraction(double flow_fraction, double haematocrit, double parent_um, double a_um,
                                double b_um) {
  const double h = (1 - haematocrit) / parent_um;
  const double threshold = 0.964 * h;
  // In vessels so narrow that both thresholds meet, the branch with more flow gets all cells.
  if (threshold >= 0.5) return flow_fraction > 0.5 ? 1 : flow_fraction < 0.5 ? 0 : 0.5;
  const double y = (flow_fraction - threshold) / (1 - 2 * threshold);
  if (y <= 0) return 0;
  if (y >= 1) return 1;
  const double q = (a_um / b_um) * (a_um / b_um);
  const double asymmetry = -13.29 * h * (q - 1) / (q + 1), steepness = 1 + 6.98 * h;
  return 1 / (1 + std::exp(-(asymmetry + steepness * std::log(y / (1 - y)))));
}

}  // namespace rhexis::hemodynamics
