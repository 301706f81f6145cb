/// What two records of a configuration (to_json) have different.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace rhexis::input {

struct Difference {
  std::string key;   ///< "vessel.length"
  std::string text;  ///< `vessel.length was "20 mm", and now is "10 mm"`
};

/// One for every key with another value, of those that count; a key that only one of them has, too.
std::vector<Difference> differences(const nlohmann::ordered_json& earlier, const nlohmann::ordered_json& now,
                                    const std::function<bool(const std::string& key)>& counts);

}  // namespace rhexis::input
