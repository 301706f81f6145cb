// SPDX-License-Identifier: BSD-3-Clause
/// A course of the pressure from a CSV file: columns "time [s]" and "pressure [mmHg]", in any units of their
/// kinds and in any order (core/csv_table.hpp).
#pragma once

#include <string>
#include <vector>

#include "core/csv_table.hpp"
#include "core/parameter.hpp"

namespace rhexis::peridynamics {

/// Points (s, Pa) of `text`, which is that of `file`. Throws InputError with file, line, column and value
/// where a field is missing or is no number, a pressure is negative, or times do not increase.
std::vector<CurvePoint> schedule_table(const std::string& file, std::string text, const ToSi& to_si);

/// A checksum that tells one text from another: FNV-1a of 64 bits (Fowler, Noll, Vo), as "fnv1a:" and 16
/// hexadecimal digits. It protects against slips, not against forgers.
std::string checksum(const std::string& text);

}  // namespace rhexis::peridynamics
