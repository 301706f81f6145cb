// SPDX-License-Identifier: BSD-3-Clause
/// What two records of a configuration (to_json) have different.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace rhexis::input {

/// Whether it is built as a record: an object of sections, which are objects of keys, which are objects.
/// Asked of what was read from a file.
bool is_record(const nlohmann::ordered_json& json);

struct Difference {
  std::string key;   ///< "vessel.length"
  std::string text;  ///< `vessel.length was "20 mm", and now is "10 mm"`
};

/// One for every key with another value, of those that count; a key that only one of them has, too. Both must
/// be records.
std::vector<Difference> differences(const nlohmann::ordered_json& earlier, const nlohmann::ordered_json& now,
                                    const std::function<bool(const std::string& key)>& counts);

}  // namespace rhexis::input
