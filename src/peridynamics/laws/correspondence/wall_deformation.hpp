// SPDX-License-Identifier: BSD-3-Clause
/// What a law by gradient knows of a particle at one moment.
#pragma once

#include <array>

#include "peridynamics/laws/correspondence/tensor.hpp"

namespace rhexis::peridynamics {

struct WallDeformation {
  Tensor<double> gradient = Tensor<double>::zero();  ///< H = F - 1
  Tensor<double> stress =
      Tensor<double>::zero();             ///< first Piola-Kirchhoff stress P that the particle bears, Pa
  std::array<double, 3> hoop{}, axial{};  ///< unit vectors along the wall at rest
  double fibre_stretch = 1;               ///< the largest of the families of fibres
};

}  // namespace rhexis::peridynamics
