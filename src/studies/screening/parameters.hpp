// SPDX-License-Identifier: BSD-3-Clause
/// Input keys of the section screening.
#pragma once

#include <cstdint>

#include "core/parameter.hpp"

namespace rhexis::screening {

struct Parameters {
  std::int64_t top = 0;
  double critical_stretch = 0.25;
};

ParameterList declare(Parameters& p);

}  // namespace rhexis::screening
