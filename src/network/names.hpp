// SPDX-License-Identifier: BSD-3-Clause
/// Junctions and vessels by the ids and names that a user's file gives them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "network/graph.hpp"

namespace rhexis::network {

/// The spelling that an id has in common with others of it: "7" of "7", "7.0" and "7.", as spreadsheets write
/// whole numbers.
std::string_view canonical_id(std::string_view id);

/// The junction or vessel of an id, or else of a name that the file gives beside the id; none: there is none.
/// Without ids of its own in the file, its number is the id. Throws InputError for a name that several have.
std::optional<std::uint32_t> find_junction(const Graph& graph, const std::string& name);
std::optional<std::uint32_t> find_vessel(const Graph& graph, const std::string& name);

}  // namespace rhexis::network
