// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/laws/law_parameters.hpp"

#include "core/error.hpp"
#include "core/format.hpp"
#include "peridynamics/laws/pmb.hpp"

namespace rhexis::peridynamics {

ParameterList declare(LawChoice& law) {
  return {
      {.key = "material.law",
       .target = &law.name,
       .meaning = "How bonds pull: pmb (in proportion to their stretch s, the paper's), fung (stiffening as "
                  "collagen does, exp(a s^2) times as strong) or lps (linear peridynamic solid: state-based, "
                  "any Poisson's ratio).",
       .source = "Eq. (2); Fung 1979; Silling 2007",
       .choices = {"pmb", "fung", "lps"}},
      {.key = "material.poisson_ratio",
       .target = &law.poisson_ratio,
       .unit = "1",
       .meaning = "Poisson's ratio; other than 1/4 only with law = \"lps\".",
       .source = "Silling 2007",
       .range = {.lower = -1, .upper = 0.4999, .lower_open = true}},
      {.key = "material.fung_exponent",
       .target = &law.fung_exponent,
       .unit = "1",
       .meaning = "The exponent a; to be given with law = \"fung\", and only there.",
       .range = {.lower = 0, .upper = 50, .lower_open = true}},
  };
}

void resolve(const LawChoice& law) {
  if (law.name != "lps" && law.poisson_ratio != Pmb::poisson_ratio) {
    throw InputError("material.law = \"" + law.name +
                         "\" is bond-based: its Poisson's ratio is 1/4; for another take \"lps\"",
                     "material.poisson_ratio");
  }
  if (law.name != "fung") {
    if (law.fung_exponent)
      throw InputError("only for material.law = \"fung\", not \"" + law.name + "\"",
                       "material.fung_exponent");
    return;
  }
  if (!law.fung_exponent)
    throw InputError("material.law = \"fung\" needs an exponent, such as 10", "material.fung_exponent");
}

void check_hardening(const LawChoice& law, double critical_stretch) {
  if (law.name != "fung") return;
  const double at_break = *law.fung_exponent * critical_stretch * critical_stretch;
  if (at_break > 10) {
    throw InputError(
        "a bond would pull exp(" + text(at_break) +
            ") times as hard as a linear one before it breaks; a critical_stretch^2 may be 10 at most",
        "material.fung_exponent");
  }
}

}  // namespace rhexis::peridynamics
