// SPDX-License-Identifier: BSD-3-Clause
#include "studies/screening/parameters.hpp"

namespace rhexis::screening {

ParameterList declare(Parameters& p) {
  return {
      {.key = "screening.top",
       .target = &p.top,
       .unit = "1",
       .meaning = "How many vessels at highest risk are listed; 0: vessels are not screened. Risk is the "
                  "hoop strain at the lumen, under the mean of the pressures at the vessel's ends, over the "
                  "wall's critical stretch.",
       .range = Range::between(0, 10000)},
      {.key = "screening.critical_stretch",
       .target = &p.critical_stretch,
       .unit = "1",
       .meaning = "Critical stretch of a wall that is not weak.",
       .source = "Table 2",
       .range = Range::positive(),
       .only_with = {{"screening.top", {}}}},
  };
}

}  // namespace rhexis::screening
