// SPDX-License-Identifier: BSD-3-Clause
/// All bond laws, by name: a new law is a header and a place in this list.
#pragma once

#include <stdexcept>
#include <tuple>
#include <type_traits>
#include <utility>

#include "peridynamics/laws/fung.hpp"
#include "peridynamics/laws/law_parameters.hpp"
#include "peridynamics/laws/lps.hpp"
#include "peridynamics/laws/pmb.hpp"

namespace rhexis::peridynamics {

/// In the order in which `rhexis keys` names them.
using AllLaws = std::tuple<Pmb, Fung, Lps>;

/// Calls `use.operator()<Law>()` for each law.
template <class Use>
void for_each_law(const Use& use) {
  [&]<class... Law>(std::type_identity<std::tuple<Law...>>) {
    (use.template operator()<Law>(), ...);
  }(std::type_identity<AllLaws>{});
}

/// Returns use(law) for the law that was chosen. All its results are of one type.
template <std::size_t i = 0, class Use>
auto with_law(const LawChoice& choice, const Use& use) {
  using Law = std::tuple_element_t<i, AllLaws>;
  if constexpr (i + 1 < std::tuple_size_v<AllLaws>) {
    if (choice.name != Law::name) return with_law<i + 1>(choice, use);
  } else if (choice.name != Law::name) {
    throw std::invalid_argument("no law " + choice.name);
  }
  return use(Law(choice));
}

}  // namespace rhexis::peridynamics
