// SPDX-License-Identifier: BSD-3-Clause
/// A graph from the rows of a file, checked one by one: whatever the format, the same mistakes get the same
/// messages.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "core/csv_table.hpp"
#include "network/graph.hpp"

namespace rhexis::network {

/// One junction as read, in SI; what is not given is empty.
struct JunctionRow {
  std::string id;
  std::optional<double> x, y, z;                     ///< m
  std::optional<double> pressure, flow, resistance;  ///< Pa, m3/s (into the network), Pa s/m3
};

/// One vessel as read, in SI.
struct VesselRow {
  std::string id, from, to;
  std::optional<double> radius, length, wall_thickness;  ///< m; without length: the distance of the ends
  std::string kind;                                      ///< "artery", "vein", "unknown" or empty
  std::optional<double> generation;
};

class NetworkBuilder {
 public:
  /// `where` opens a message about the row, e.g. `vessels.csv:12`. Throws InputError for what cannot be.
  void add(const JunctionRow& row, const std::string& where);
  void add(const VesselRow& row, const std::string& where);
  /// Throws InputError where there is no vessel, or none at a junction with a pressure or a flow.
  BoundedGraph finish(const std::string& file);

 private:
  [[noreturn]] static void refuse(const std::string& where, const std::string& problem);
  std::uint32_t junction(const std::string& id, const std::string& column, const std::string& where) const;
  double length_of(const VesselRow& row, std::uint32_t from, std::uint32_t to,
                   const std::string& where) const;

  BoundedGraph network_;
  std::unordered_map<std::string, std::uint32_t> junctions_, vessels_;
};

}  // namespace rhexis::network
