// SPDX-License-Identifier: BSD-3-Clause
#include "network/condition_limits.hpp"

#include <fmt/format.h>

#include <cmath>

namespace rhexis::network {

std::string impossible_condition(BoundaryCondition::Kind kind, double value) {
  if (kind == BoundaryCondition::Kind::pressure && std::abs(value) > highest_pressure)
    return fmt::format("a pressure of {}, beyond {}: is the unit right?", mmhg(value),
                       mmhg(highest_pressure));
  if (kind == BoundaryCondition::Kind::flow && std::abs(value) > largest_flow)
    return fmt::format("a flow of {} L/min, beyond {} L/min: is the unit right?",
                       text(value * litres_per_minute), text(largest_flow * litres_per_minute));
  return {};
}

}  // namespace rhexis::network
