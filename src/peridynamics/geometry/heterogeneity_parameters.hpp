// SPDX-License-Identifier: BSD-3-Clause
/// Input keys of a wall whose properties differ from place to place.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/parameter.hpp"

namespace rhexis::peridynamics {

/// Distributions of mean 1.
enum class ScatterLaw { lognormal, weibull };

constexpr auto name_table(ScatterLaw) {
  using enum ScatterLaw;
  return std::to_array<Named<ScatterLaw>>({{lognormal, "lognormal"}, {weibull, "weibull"}});
}

/// Section [scatter]: the random part.
struct Scatter {
  ScatterLaw law = ScatterLaw::lognormal;         ///< the distribution of the factors
  double critical_stretch = 0;                    ///< coefficient of variation
  double stiffness = 0;                           ///< coefficient of variation
  std::optional<double> correlation_length = {};  ///< m
  std::int64_t seed = 1;

  bool none() const { return critical_stretch == 0 && stiffness == 0; }
};

/// A section [[spot]]: a place where the wall is different.
struct Spot {
  double position = 0;          ///< m, of the centre along the axis, from the end z = 0
  double angle = 0;             ///< rad, of the centre around the axis, from x towards y
  double radius = 0;            ///< m, along the axis and along the circle at mid-wall
  double critical_stretch = 1;  ///< factor at the centre
  double stiffness = 1;         ///< factor at the centre
  double thickness = 1;         ///< share of the wall that is left at the centre, from the lumen on
};

struct Spots {
  std::vector<Spot> list;
  double period = INFINITY;  ///< m: distances along the axis are those round a ring of this length

  /// Whether the wall is thinner at one of them.
  bool thin_the_wall() const;

  /// 1 at the centre of `spot`, 0 from its radius on: (1 + cos(pi d / radius)) / 2 at distance d along the
  /// circle of `mid_radius` and the axis; angle in rad, lengths in m.
  double nearness(const Spot& spot, double mid_radius, double angle, double z) const;
};

ParameterList declare(Scatter& s);
ParameterList declare(Spots& s);

/// Fills the correlation length. Lengths in m. Throws InputError with the key at fault. Returns warnings.
std::vector<std::string> resolve(Scatter& s, double wall, double spacing);

/// Lengths in m. Throws InputError with the key at fault. Returns warnings.
std::vector<std::string> check(const Spots& s, double length, double wall, double spacing);

}  // namespace rhexis::peridynamics
