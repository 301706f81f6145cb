// SPDX-License-Identifier: BSD-3-Clause
/// A graph from the rows of a file, checked one by one: whatever the format, the same mistakes get the same
/// messages, all of them at once.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/error.hpp"
#include "core/faults.hpp"
#include "core/heading.hpp"
#include "network/files/file_options.hpp"
#include "network/graph.hpp"

namespace rhexis::network {

/// One junction as read, in SI; what is not given is empty.
struct JunctionRow {
  std::string id = {}, name = {};
  std::optional<double> x = {}, y = {}, z = {};                     ///< m
  std::optional<double> pressure = {}, flow = {}, resistance = {};  ///< Pa, m3/s (into the network), Pa s/m3
  std::optional<double> haematocrit = {};  ///< of the blood that enters, as a fraction
  bool tells_direction = false;            ///< whether blood flows in or out, in the place of how much
};

/// One vessel as read, in SI.
struct VesselRow {
  std::string id, name, from, to;
  std::optional<double> radius, length, wall_thickness;  ///< m; without length: the distance of the ends
  std::string kind;                                      ///< "artery", "vein", "unknown" or empty
  std::optional<double> generation;
};

/// What the tables, lists and attributes of junctions and vessels are called, here and by other programs.
const Columns& junction_columns();
const Columns& vessel_columns();

/// Whether a text in the place of a flow is a direction: "in", "outlet" and the like.
bool is_direction(std::string_view text);

/// The row of a `record`, which has `std::string text(name)` and `std::optional<double> number(name)` for
/// names of columns.
template <class Record>
JunctionRow junction_row(Record&& record) {
  JunctionRow row{.id = record.text("id"),
                  .name = record.text("name"),
                  .x = record.number("x"),
                  .y = record.number("y"),
                  .z = record.number("z"),
                  .pressure = record.number("pressure"),
                  .resistance = record.number("resistance"),
                  .haematocrit = record.number("haematocrit")};
  try {
    row.flow = record.number("flow");
  } catch (const InputError&) {
    row.tells_direction = is_direction(record.text("flow"));
    if (!row.tells_direction) throw;
  }
  return row;
}

template <class Record>
VesselRow vessel_row(Record&& record) {
  std::optional<double> radius = record.number("radius");
  if (const auto diameter = record.number("diameter")) {
    if (radius) throw InputError(record.where() + ": give one of radius and diameter");
    radius = *diameter / 2;
  }
  return {record.text("id"),
          record.text("name"),
          record.text("from"),
          record.text("to"),
          radius,
          record.number("length"),
          record.number("wall_thickness"),
          record.text("kind"),
          record.number("generation")};
}

class NetworkBuilder {
 public:
  explicit NetworkBuilder(const FileOptions& options) : options_(options) {}

  /// Reads a junction or vessel of `record` and adds it; what is wrong with it is collected.
  template <class Record>
  void add_junction(Record&& record) {
    if (faults_.collect([&] { add(junction_row(record), record.where()); })) return;
    try {
      mention_junction(record.text("id"));
    } catch (const InputError&) {
      lose_junction();
    }
  }
  template <class Record>
  void add_vessel(Record&& record, std::uint32_t line = 0) {
    faults_.collect([&] { add(vessel_row(record), record.where(), line); });
  }

  /// `where` opens a message about the row, e.g. `vessels.csv:12`. Throw InputError for what cannot be.
  void add(const JunctionRow& row, const std::string& where);
  /// `line`: of the row in its file, from 1; 0: the file has no lines.
  void add(const VesselRow& row, const std::string& where, std::uint32_t line = 0);
  /// A junction of which no more is known than that it is there: vessels that name it are not at fault.
  void mention_junction(const std::string& id);
  /// A junction whose id could not be read either: from now on no vessel is at fault that names an unknown
  /// one.
  void lose_junction() { lost_junctions_ = true; }

  Faults& faults() { return faults_; }
  void note(std::string sentence) { network_.notes.push_back(std::move(sentence)); }
  /// Notes that columns or members of the file are not read, if there are any.
  void note_ignored(const std::string& file, const std::string& what, const std::vector<std::string>& names);
  /// A length has taken its unit from network.file_length_unit.
  void use_length_unit() { uses_length_unit_ = true; }

  /// Throws InputError with all faults, or where there is no vessel, or none at a junction with a pressure or
  /// a flow.
  BoundedGraph finish(const std::string& file);

 private:
  [[noreturn]] static void refuse(const std::string& where, const std::string& problem);
  void add_condition(const JunctionRow& row, std::uint32_t junction, const std::string& where);
  std::uint32_t junction(const std::string& id, const std::string& column, const std::string& where) const;
  double length_of(const VesselRow& row, std::uint32_t from, std::uint32_t to,
                   const std::string& where) const;
  void add_notes(const std::string& file);

  const FileOptions& options_;
  Faults faults_;
  BoundedGraph network_;
  std::unordered_map<std::string, std::uint32_t> junctions_, vessels_;  ///< by canonical id
  std::optional<bool> has_coordinates_;                                 ///< once a junction has been read
  std::vector<std::string> self_loops_, idle_haematocrits_;             ///< ids of what is left out
  bool lost_junctions_ = false, uses_length_unit_ = false;
};

}  // namespace rhexis::network
