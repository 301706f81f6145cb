// SPDX-License-Identifier: BSD-3-Clause
/// Layers of an artery's wall and the families of fibres in them, as input tells of them.
#pragma once

#include <string>
#include <vector>

#include "core/parameter.hpp"

namespace rhexis::peridynamics {

/// A section [[fibre]]: fibres of one direction.
struct FibreFamily {
  std::string layer;      ///< name of the layer that they are in
  double angle = 0;       ///< rad, from the circumference towards the axis
  double k1 = 0, k2 = 0;  ///< Pa; 1
  double dispersion = 0;  ///< kappa, 0 to 1/3
};

/// A section [[layer]]; layers are listed from the lumen outwards.
struct WallLayer {
  std::string name;
  double thickness = 1;                  ///< its share of the wall's thickness
  double shear_modulus = 0;              ///< Pa, of the matrix
  std::vector<FibreFamily> fibres = {};  ///< those of [[fibre]] that are in this layer
};

struct LayerInput {
  std::vector<WallLayer> layers;
  std::vector<FibreFamily> fibres;
};

ParameterList declare(LayerInput& input);

/// The layers with their fibres. Throws InputError where shares of the thickness do not sum to 1, a name
/// comes twice, or a fibre is in no layer.
std::vector<WallLayer> wall_layers(const LayerInput& input);

}  // namespace rhexis::peridynamics
