// SPDX-License-Identifier: BSD-3-Clause
#include "network/names.hpp"

#include <algorithm>
#include <vector>

#include "core/error.hpp"

namespace rhexis::network {
namespace {

/// `count` items of `kind` ("vessels"), with ids and further names, each list empty where the file has none.
std::optional<std::uint32_t> find(const std::string& name, std::size_t count,
                                  const std::vector<std::string>& ids, const std::vector<std::string>& names,
                                  const char* kind) {
  const auto number = [](const std::vector<std::string>& list, auto found) {
    return static_cast<std::uint32_t>(found - list.begin());
  };
  const std::string_view id = canonical_id(name);
  if (ids.empty()) {
    const bool is_number = !id.empty() && id.size() < 10 && id.find_first_not_of("0123456789") == id.npos;
    if (is_number && std::stoul(std::string(id)) < count)
      return static_cast<std::uint32_t>(std::stoul(std::string(id)));
  }
  if (const auto found = std::ranges::find(ids, name); found != ids.end()) return number(ids, found);
  const auto alike = std::ranges::find(ids, id, [](const std::string& other) { return canonical_id(other); });
  if (alike != ids.end()) return number(ids, alike);
  const auto found = std::ranges::find(names, name);
  if (name.empty() || found == names.end()) return std::nullopt;
  if (std::find(found + 1, names.end(), name) != names.end())
    throw InputError(std::string("several ") + kind + " are called '" + name + "'; name one by its id");
  return number(names, found);
}

}  // namespace

std::string_view canonical_id(std::string_view id) {
  const auto point = id.find('.');
  if (point == 0 || point == std::string_view::npos) return id;
  const auto end = id.find_last_not_of('0');
  const bool whole_number = end == point && id.substr(0, point).find_first_not_of("0123456789") == id.npos;
  return whole_number ? id.substr(0, point) : id;
}

std::optional<std::uint32_t> find_junction(const Graph& graph, const std::string& name) {
  return find(name, graph.junctions, graph.junction_name, graph.junction_label, "junctions");
}

std::optional<std::uint32_t> find_vessel(const Graph& graph, const std::string& name) {
  return find(name, graph.vessels(), graph.vessel_name, graph.vessel_label, "vessels");
}

}  // namespace rhexis::network
