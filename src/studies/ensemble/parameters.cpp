// SPDX-License-Identifier: BSD-3-Clause
#include "studies/ensemble/parameters.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/format.hpp"

namespace rhexis::ensemble {

ParameterList declare(Parameters& p) {
  return {
      {.key = "ensemble.pressures",
       .target = &p.pressures,
       .unit = "Pa",
       .meaning = "Pressures that every wall meets, each after the schedule, as "
                  "load.pressure: [\"100 mmHg\", \"150 mmHg\"]; or give lowest_pressure, highest_pressure "
                  "and pressure_count.",
       .range = Range::positive()},
      {.key = "ensemble.lowest_pressure",
       .target = &p.lowest_pressure,
       .unit = "Pa",
       .meaning = "First of pressure_count evenly spaced pressures.",
       .range = Range::positive()},
      {.key = "ensemble.highest_pressure",
       .target = &p.highest_pressure,
       .unit = "Pa",
       .meaning = "Last of them.",
       .range = Range::positive()},
      {.key = "ensemble.pressure_count",
       .target = &p.pressure_count,
       .unit = "1",
       .meaning = "How many there are.",
       .range = Range::between(2, 10000)},
      {.key = "ensemble.samples",
       .target = &p.samples,
       .unit = "1",
       .meaning = "Walls drawn; each of them meets every pressure. More can be added to a finished ensemble.",
       .range = Range::between(1, 1e6)},
      {.key = "ensemble.seed",
       .target = &p.seed,
       .unit = "1",
       .meaning = "Of the random numbers; wall i is a function of seed and i alone.",
       .range = Range::not_negative()},
      {.key = "ensemble.strength_spread",
       .target = &p.strength_spread,
       .unit = "1",
       .meaning =
           "Coefficient of variation of the walls' critical stretch: a lognormal factor of mean 1 on "
           "material.critical_stretch, or on the one that material.energy_release_rate gives the mean wall.",
       .range = Range::between(0, 1)},
      {.key = "ensemble.thickness_spread",
       .target = &p.thickness_spread,
       .unit = "1",
       .meaning =
           "The same of their thickness, with the lumen as it is: the outer radius is r0 + f (r1 - r0).",
       .range = Range::between(0, 1)},
      {.key = "ensemble.stiffness_spread",
       .target = &p.stiffness_spread,
       .unit = "1",
       .meaning = "The same of their stiffness, a factor on material.young_modulus (or on the moduli of "
                  "layers and fibres).",
       .range = Range::between(0, 1)},
  };
}

namespace {

void resolve_pressures(Parameters& p) {
  const bool range = p.lowest_pressure || p.highest_pressure || p.pressure_count;
  if (range && !p.pressures.empty()) {
    throw InputError(
        "give either this list or a range (lowest_pressure, highest_pressure, pressure_count), not both",
        "ensemble.pressures");
  }
  if (!range && p.pressures.empty()) {
    throw InputError(
        "give a list of pressures, or a range: lowest_pressure, highest_pressure and pressure_count",
        "ensemble.pressures");
  }
  if (!range) {
    std::sort(p.pressures.begin(), p.pressures.end());
    const auto twice = std::adjacent_find(p.pressures.begin(), p.pressures.end());
    if (twice != p.pressures.end())
      throw InputError(quantity(*twice, "Pa", 6) + " stands there twice", "ensemble.pressures");
    return;
  }
  const std::string needed = "a range needs lowest_pressure, highest_pressure and pressure_count";
  if (!p.lowest_pressure) throw InputError(needed, "ensemble.lowest_pressure");
  if (!p.highest_pressure) throw InputError(needed, "ensemble.highest_pressure");
  if (!p.pressure_count) throw InputError(needed, "ensemble.pressure_count");
  if (*p.highest_pressure <= *p.lowest_pressure) {
    throw InputError("must be above ensemble.lowest_pressure, " + quantity(*p.lowest_pressure, "Pa", 6),
                     "ensemble.highest_pressure");
  }
  for (std::int64_t i = 0; i < *p.pressure_count; ++i) {
    p.pressures.push_back(std::lerp(*p.lowest_pressure, *p.highest_pressure,
                                    static_cast<double>(i) / static_cast<double>(*p.pressure_count - 1)));
  }
}

}  // namespace

void resolve(Parameters& p) {
  resolve_pressures(p);
  constexpr std::int64_t most = 10'000'000;
  if (p.vessels() > most) {
    throw InputError(std::to_string(p.vessels()) + " samples with " + std::to_string(p.pressures.size()) +
                         " pressures; at most 10 million are possible",
                     "ensemble.samples");
  }
}

}  // namespace rhexis::ensemble
