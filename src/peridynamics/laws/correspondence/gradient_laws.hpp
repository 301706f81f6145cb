// SPDX-License-Identifier: BSD-3-Clause
/// All laws by deformation gradient, by name: a new law is a header, a place in this list, and how
/// `gradient_law` (tube_setup.cpp) makes it from input.
#pragma once

#include <type_traits>
#include <variant>

#include "peridynamics/laws/correspondence/fibre_reinforced.hpp"
#include "peridynamics/laws/correspondence/neo_hookean.hpp"

namespace rhexis::peridynamics {

/// In the order in which `rhexis keys` names them.
using GradientLaw = std::variant<NeoHookean, FibreReinforced>;

/// Calls `use.operator()<Law>()` for each law.
template <class Use>
void for_each_gradient_law(const Use& use) {
  [&]<class... Law>(std::type_identity<std::variant<Law...>>) {
    (use.template operator()<Law>(), ...);
  }(std::type_identity<GradientLaw>{});
}

}  // namespace rhexis::peridynamics
