// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/surroundings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/format.hpp"

namespace rhexis::coupling {
namespace {

/// The compression acts between two planes across an axis.
void check_range(const Compression& compression, const VesselPlace& place,
                 std::vector<std::string>& warnings) {
  if (!place.start)
    throw InputError("needs coordinates of the network, and it has none", "body.compression_from");
  const auto axis = static_cast<std::size_t>(compression.axis);
  if (place.extent) {
    const auto [low, high] = (*place.extent)[axis];
    if (compression.to < low || compression.from > high) {
      throw InputError(fmt::format("the compression lies outside the body, which reaches from {} m to {} m",
                                   text(low), text(high)),
                       compression.to < low ? "body.compression_to" : "body.compression_from");
    }
  }
  const std::pair<double, double> ends = std::minmax((*place.start)[axis], (*place.end)[axis]);
  const auto within = [&](double edge) { return edge > ends.first && edge < ends.second; };
  if (within(compression.from) || within(compression.to)) {
    warnings.push_back(
        "an edge of the compression lies within the vessel, whose load is taken at its two ends "
        "and its middle, and straight between them");
  }
  if (ends.second < compression.from || ends.first > compression.to)
    warnings.push_back(fmt::format("the compression does not reach vessel {}", place.name));
}

}  // namespace

std::array<PressureParts, 3> surroundings(const Parameters& p, const VesselPlace& place,
                                          const hemodynamics::Hydrostatic& weight,
                                          std::vector<std::string>& warnings) {
  const Compression compression = coupling::compression(p);
  if (std::isfinite(compression.from) || std::isfinite(compression.to))
    check_range(compression, place, warnings);
  std::array<PressureParts, 3> parts{};
  for (std::size_t i = 0; i < 3; ++i) {
    parts[i].tension = p.tension;
    parts[i].atmosphere = p.atmosphere;
    parts[i].compression = compression.pressure;
    if (!place.start) continue;
    std::array<double, 3> x{};
    for (std::size_t k = 0; k < 3; ++k)
      x[k] = std::lerp((*place.start)[k], (*place.end)[k], 0.5 * static_cast<double>(i));
    parts[i].acceleration = weight.pressure(x[0], x[1], x[2]);
    parts[i].compression = compression.at(x);
  }
  return parts;
}

}  // namespace rhexis::coupling
