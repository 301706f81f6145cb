// SPDX-License-Identifier: BSD-3-Clause
/// Input keys of section ensemble.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/parameter.hpp"

namespace rhexis::ensemble {

struct Parameters {
  std::vector<double> pressures = {};                                 ///< Pa, ascending once resolved
  std::optional<double> lowest_pressure = {}, highest_pressure = {};  ///< Pa
  std::optional<std::int64_t> pressure_count = {};
  std::int64_t samples = 100;  ///< walls that meet every pressure
  std::int64_t seed = 1;
  double strength_spread = 0, thickness_spread = 0, stiffness_spread = 0;  ///< coefficients of variation

  /// Vessels to simulate: every wall under every pressure.
  std::int64_t vessels() const { return static_cast<std::int64_t>(pressures.size()) * samples; }
};

ParameterList declare(Parameters& p);

/// Sorts the pressures, or makes them from their range. Throws InputError with the key at fault.
void resolve(Parameters& p);

}  // namespace rhexis::ensemble
