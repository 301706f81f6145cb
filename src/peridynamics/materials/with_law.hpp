/// From a material's name to its law.
#pragma once

#include "peridynamics/materials/fung.hpp"
#include "peridynamics/materials/pmb.hpp"
#include "peridynamics/parameters.hpp"

namespace rhexis::peridynamics {

/// What `use` makes of the law that `material` names.
template <class Use>
auto with_law(const Material& material, const Use& use) {
  switch (material.law) {
    case MaterialLaw::fung:
      return use(Fung{material.fung_exponent});
    case MaterialLaw::pmb:
      break;
  }
  return use(Pmb{});
}

}  // namespace rhexis::peridynamics
