// SPDX-License-Identifier: BSD-3-Clause
/// JSON as records and checkpoints write it.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

namespace rhexis::output {

/// `value`, or null where there is none.
template <class T>
nlohmann::ordered_json or_null(const std::optional<T>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

}  // namespace rhexis::output
