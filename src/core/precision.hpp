// SPDX-License-Identifier: BSD-3-Clause
/// Single or double, where the input may choose.
#pragma once

#include "core/enum_names.hpp"

namespace rhexis {

enum class Precision { single_precision, double_precision };

constexpr auto name_table(Precision) {
  using enum Precision;
  return std::to_array<Named<Precision>>({{single_precision, "single"}, {double_precision, "double"}});
}

}  // namespace rhexis
