/// Input keys of a wall whose properties differ from place to place.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/parameter.hpp"

namespace rhexis::peridynamics {

/// Section [scatter]: the random part.
struct Scatter {
  std::string law = "lognormal";                  ///< of the factors: "lognormal" | "weibull"
  double critical_stretch = 0;                    ///< coefficient of variation
  double stiffness = 0;                           ///< coefficient of variation
  std::optional<double> correlation_length = {};  ///< m
  std::int64_t seed = 1;

  bool none() const { return critical_stretch == 0 && stiffness == 0; }
};

ParameterList declare(Scatter& s);

/// Fills the correlation length. Lengths in m. Throws InputError with the key at fault. Returns warnings.
std::vector<std::string> resolve(Scatter& s, double wall, double spacing);

}  // namespace rhexis::peridynamics
