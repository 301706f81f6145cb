// SPDX-License-Identifier: BSD-3-Clause
/// Input keys of the material's law.
#pragma once

#include <optional>
#include <string>

#include "core/parameter.hpp"

namespace rhexis::peridynamics {

/// A law (see laws/) and its own numbers.
struct LawChoice {
  std::string name = "pmb";  ///< "pmb" | "fung" | "lps"
  double poisson_ratio = 0.25;
  std::optional<double> fung_exponent = {};  ///< given where the law is "fung"
};

/// The keys of section material that say which law.
ParameterList declare(LawChoice& law);

/// Throws InputError with the key at fault where a number does not go with the law.
void resolve(const LawChoice& law);

/// Throws InputError where bonds would pull out of all proportion before they break.
void check_hardening(const LawChoice& law, double critical_stretch);

}  // namespace rhexis::peridynamics
