// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/laws/correspondence/wall_layers.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/format.hpp"

namespace rhexis::peridynamics {

ParameterList declare(LayerInput& input) {
  constexpr double right_angle = std::numbers::pi / 2;
  return {
      {.key = "layer.name",
       .target = ListTarget(&input.layers, &WallLayer::name),
       .meaning = "Name of the layer, such as \"media\"; layers are given from the lumen outwards.",
       .required = true},
      {.key = "layer.thickness",
       .target = ListTarget(&input.layers, &WallLayer::thickness),
       .unit = "1",
       .meaning = "Share of the wall's thickness; shares sum to 1.",
       .range = {.lower = 0, .upper = 1, .lower_open = true}},
      {.key = "layer.shear_modulus",
       .target = ListTarget(&input.layers, &WallLayer::shear_modulus),
       .unit = "Pa",
       .default_in = "kPa",
       .meaning = "Shear modulus mu of the layer's matrix (c of Holzapfel, Gasser & Ogden 2000).",
       .range = Range::positive(),
       .required = true},
      {.key = "fibre.layer",
       .target = ListTarget(&input.fibres, &FibreFamily::layer),
       .meaning = "Name of the layer that this family of fibres is in.",
       .required = true},
      {.key = "fibre.angle",
       .target = ListTarget(&input.fibres, &FibreFamily::angle),
       .unit = "rad",
       .default_in = "deg",
       .meaning =
           "Direction of the fibres at rest, from the circumference towards the axis; a pair of families "
           "is two sections, of angles with both signs.",
       .source = "Holzapfel, Gasser & Ogden 2000",
       .range = Range::between(-right_angle, right_angle)},
      {.key = "fibre.k1",
       .target = ListTarget(&input.fibres, &FibreFamily::k1),
       .unit = "Pa",
       .default_in = "kPa",
       .meaning = "Stiffness k1 of the family.",
       .source = "Holzapfel, Gasser & Ogden 2000",
       .range = Range::positive(),
       .required = true},
      {.key = "fibre.k2",
       .target = ListTarget(&input.fibres, &FibreFamily::k2),
       .unit = "1",
       .meaning = "How fast the family stiffens, k2.",
       .source = "Holzapfel, Gasser & Ogden 2000",
       .range = Range::positive(),
       .required = true},
      {.key = "fibre.dispersion",
       .target = ListTarget(&input.fibres, &FibreFamily::dispersion),
       .unit = "1",
       .meaning = "Dispersion kappa of the fibres' directions: 0 for none, 1/3 for all directions alike.",
       .source = "Gasser, Ogden & Holzapfel 2006",
       .range = Range::between(0, 1.0 / 3)},
  };
}

std::vector<WallLayer> wall_layers(const LayerInput& input) {
  std::vector<WallLayer> layers = input.layers;
  double total = 0;
  std::string names;
  const auto named = [&](const std::string& name) {
    return std::ranges::find(layers, name, &WallLayer::name);
  };
  for (auto layer = layers.begin(); layer != layers.end(); ++layer) {
    total += layer->thickness;
    if (named(layer->name) != layer)
      throw InputError("\"" + layer->name + "\" names an earlier layer",
                       "layer[" + std::to_string(layer - layers.begin() + 1) + "].name");
    names += (names.empty() ? "\"" : ", \"") + layer->name + "\"";
  }
  if (std::abs(total - 1) > 1e-6)
    throw InputError("the shares of the wall's thickness sum to " + text(total) + "; they must sum to 1",
                     "layer[" + std::to_string(layers.size()) + "].thickness");
  for (std::size_t f = 0; f < input.fibres.size(); ++f) {
    const auto layer = named(input.fibres[f].layer);
    if (layer == layers.end())
      throw InputError("no layer has the name \"" + input.fibres[f].layer + "\", only " + names,
                       "fibre[" + std::to_string(f + 1) + "].layer");
    layer->fibres.push_back(input.fibres[f]);
  }
  return layers;
}

}  // namespace rhexis::peridynamics
