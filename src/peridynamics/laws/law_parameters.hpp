// SPDX-License-Identifier: BSD-3-Clause
/// Input keys of the material's law.
#pragma once

#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/parameter.hpp"
#include "peridynamics/laws/correspondence/wall_layers.hpp"

namespace rhexis::peridynamics {

/// A law by its name (laws/all_laws.hpp), and the numbers that it takes from section material.
struct LawChoice {
  std::string name = "pmb";
  double poisson_ratio = 0.25;
  std::map<std::string, std::optional<double>> numbers = {};  ///< by name, such as "fung_exponent"
  LayerInput wall = {};                                       ///< of law "fibre_reinforced"

  /// Whether the law is evaluated at the deformation gradient (laws/correspondence), by the general engine;
  /// else it is one of bonds.
  bool by_gradient() const;

  /// A number that the law needs; throws std::out_of_range where it was not given.
  double number(const std::string& key) const {
    const auto found = numbers.find(key);
    if (found == numbers.end() || !found->second)
      throw std::out_of_range("material." + key + " is not given");
    return *found->second;
  }
};

/// A plain number that a law needs, a key of section material.
struct LawNumber {
  std::string_view name;     ///< "fung_exponent"
  std::string_view meaning;  ///< "The exponent a"
  std::string_view example;  ///< what an error asks for: "an exponent, such as 10"
  Range range;
};

/// The keys of section material that say which law, and those of each law's own numbers.
ParameterList declare(LawChoice& law);

/// Throws InputError with the key at fault where a number does not go with the law.
void resolve(const LawChoice& law);

/// Throws InputError where bonds would pull out of all proportion before they break.
void check_hardening(const LawChoice& law, double critical_stretch);

}  // namespace rhexis::peridynamics
