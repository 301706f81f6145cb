// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/turbulence_observer.hpp"

#include <fmt/format.h>

#include "core/format.hpp"
#include "hemodynamics/poiseuille.hpp"

namespace rhexis::coupling {

bool TurbulenceObserver::wants(const Moment& moment) {
  return !told_ && vessel_.due(moment.step) && simulation_.rupture().onset &&
         vessel_.state().highest_reynolds > hemodynamics::laminar_reynolds_number;
}

void TurbulenceObserver::observe(const Moment& moment) {
  told_ = true;
  warn_(fmt::format(
      "at {} the Reynolds number in the torn vessel has reached {:.0f}; above {:.0f} flow is "
      "not laminar: real resistances are higher than those of Eq. (9), and less leaks",
      quantity(moment.time_s, "s"), vessel_.state().highest_reynolds, hemodynamics::laminar_reynolds_number));
}

}  // namespace rhexis::coupling
