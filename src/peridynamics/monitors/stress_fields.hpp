// SPDX-License-Identifier: BSD-3-Clause
/// Stress and stretch of a wall as a clinician or an engineer reads them, from the deformation gradient.
///
/// Directions follow the wall: the hoop and the axial one are those of fibres that had them at rest, F e / |F
/// e|; the radial one is the normal of the deformed wall, cof F e_r / |cof F e_r|. Stress is Cauchy's, sigma
/// = P F^T / J (Holzapfel, Nonlinear Solid Mechanics, 2000, Eq. 3.9).
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "core/field_view.hpp"
#include "peridynamics/engine/body.hpp"

namespace rhexis::peridynamics {

/// Names and units of the fields below.
std::span<const FieldInfo> stress_fields();

class StressFields {
 public:
  /// Memory that this takes on all ranks.
  static double bytes(double particles);

  /// Evaluates all fields at the last observation of `body`, which must have a wall_deformation.
  void evaluate(const Body& body);

  /// Values of a field of owned particles, valid until the next evaluation.
  const std::vector<double>& values(std::string_view name) const;

 private:
  std::vector<std::vector<double>> values_;  ///< in the order of stress_fields
};

}  // namespace rhexis::peridynamics
