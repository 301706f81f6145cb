// SPDX-License-Identifier: BSD-3-Clause
/// Walls with scattered properties, each a function of (seed, number), so that the same walls meet every
/// pressure (common random numbers): differences between pressures are then none of chance.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "peridynamics/parameters.hpp"
#include "studies/ensemble/parameters.hpp"

namespace rhexis::ensemble {

/// What a wall's properties are multiplied by; 1 where the spread is 0.
struct SampledWall {
  double strength = 1, thickness = 1, stiffness = 1;
  bool operator==(const SampledWall&) const = default;
};

SampledWall draw_wall(const Parameters& p, std::int64_t wall);

/// The mean vessel `v` (resolved), its wall changed by `f`. Particles stay where they are: spacing and
/// horizon are those of the mean.
peridynamics::Parameters with_wall(peridynamics::Parameters v, const SampledWall& f);

/// Throws InputError where a wall is thinner than one spacing. Returns warnings.
std::vector<std::string> check_walls(const Parameters& p, const peridynamics::Parameters& v);

}  // namespace rhexis::ensemble
