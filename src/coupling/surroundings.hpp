// SPDX-License-Identifier: BSD-3-Clause
/// What presses on a vessel besides the blood that the heart drives: weight, tissue, atmosphere, compression.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coupling/net_pressure.hpp"
#include "coupling/parameters.hpp"
#include "hemodynamics/hydrostatic.hpp"

namespace rhexis::coupling {

/// Where a vessel lies, m; nothing where the network has no coordinates.
struct VesselPlace {
  std::string name;
  std::optional<std::array<double, 3>> start, end;
  /// The lowest and the highest coordinate of the whole network along each axis.
  std::optional<std::array<std::pair<double, double>, 3>> extent;
};

/// The parts of Eq. (7) but the heart's, at the vessel's beginning, middle and end. Adds to `warnings` where
/// a compression misses the vessel or ends within it; throws InputError where it misses the body.
std::array<PressureParts, 3> surroundings(const Parameters& p, const VesselPlace& place,
                                          const hemodynamics::Hydrostatic& weight,
                                          std::vector<std::string>& warnings);

}  // namespace rhexis::coupling
