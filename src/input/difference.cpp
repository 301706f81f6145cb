// SPDX-License-Identifier: BSD-3-Clause
#include "input/difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace rhexis::input {
namespace {

using Json = nlohmann::ordered_json;

/// What the record has of a key; null where it has none.
Json entry_of(const Json& record, const std::string& section, const std::string& name) {
  const Json::json_pointer place = Json::json_pointer() / section / name;
  return record.contains(place) ? record[place] : Json();
}

std::string written(const Json& entry) {
  return entry.is_null() ? "not there" : entry.value("written", Json()).dump();
}

bool has_checksum(const Json& entry) {
  return entry.is_object() && entry.contains("checksum");
}

}  // namespace

bool is_record(const Json& json) {
  const auto all_objects = [](const Json& of) {
    return of.is_object() && std::ranges::all_of(of, [](const Json& inner) { return inner.is_object(); });
  };
  return all_objects(json) && std::ranges::all_of(json, all_objects);
}

std::vector<Difference> differences(const Json& earlier, const Json& now,
                                    const std::function<bool(const std::string& key)>& counts) {
  std::vector<Difference> found;
  const auto compare = [&](const std::string& section, const std::string& name) {
    const std::string key = section + "." + name;
    if (!counts(key)) return;
    const Json was = entry_of(earlier, section, name), is = entry_of(now, section, name);
    if (has_checksum(was) && has_checksum(is)) {
      // A file that has been moved is the same, and one that was written anew may not be.
      if (was["checksum"] != is["checksum"])
        found.push_back({key, fmt::format("{} = {} was a file with other contents", key, written(is))});
    } else if (was.is_null() != is.is_null() ||
               (is.is_object() && was.is_object() && was.value("value", Json()) != is.value("value", Json())))
      found.push_back({key, fmt::format("{} was {}, and now is {}", key, written(was), written(is))});
  };
  for (const auto& [section, keys] : now.items()) {
    for (const auto& [name, entry] : keys.items()) compare(section, name);
  }
  for (const auto& [section, keys] : earlier.items()) {
    for (const auto& [name, entry] : keys.items()) {
      if (entry_of(now, section, name).is_null()) compare(section, name);
    }
  }
  return found;
}

}  // namespace rhexis::input
