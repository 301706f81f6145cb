#include "studies/screening/parameters.hpp"

namespace rhexis::screening {

ParameterList declare(Parameters& p) {
  return {
      {"screening.top", &p.top, "1", "0",
       "How many vessels at highest risk are listed; 0: vessels are not screened. Risk is the hoop strain at "
       "the lumen, under the mean of the pressures at the vessel's ends, over the wall's critical stretch.",
       "", Range::between(0, 10000)},
      only_with({"screening.top", {}},
                {"screening.critical_stretch", &p.critical_stretch, "1", "0.25",
                 "Critical stretch of a wall that is not weak.", "Table 2", Range::positive()}),
  };
}

}  // namespace rhexis::screening
