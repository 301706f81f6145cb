// SPDX-License-Identifier: BSD-3-Clause
/// From the name of a law to the law.
#pragma once

#include "peridynamics/laws/fung.hpp"
#include "peridynamics/laws/law_parameters.hpp"
#include "peridynamics/laws/lps.hpp"
#include "peridynamics/laws/pmb.hpp"

namespace rhexis::peridynamics {

/// What `use` makes of the law that was chosen.
template <class Use>
auto with_law(const LawChoice& choice, const Use& use) {
  if (choice.name == "fung") return use(Fung{*choice.fung_exponent});
  if (choice.name == "lps") return use(Lps(choice.poisson_ratio));
  return use(Pmb{});
}

}  // namespace rhexis::peridynamics
