// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "core/csv_table.hpp"
#include "core/error.hpp"
#include "network/files/network_file.hpp"

namespace rhexis::network {
namespace {

const CsvColumns junction_columns{{"id", ""},
                                  {"x", "m"},
                                  {"y", "m"},
                                  {"z", "m"},
                                  {"pressure", "Pa"},
                                  {"flow", "m3/s"},
                                  {"resistance", "Pa s/m3"}};
const CsvColumns vessel_columns{{"id", ""},
                                {"from", ""},
                                {"to", ""},
                                {"radius", "m"},
                                {"diameter", "m"},
                                {"length", "m"},
                                {"wall_thickness", "m"},
                                {"kind", ""},
                                {"generation", "1"}};

void require(const CsvTable& table, const std::string& name) {
  if (!table.has(name)) throw InputError(fmt::format("{}: there is no column {}", table.where(), name));
}

}  // namespace

BoundedGraph read_csv_network(const std::filesystem::path& junctions, const std::filesystem::path& vessels,
                              const ToSi& to_si) {
  NetworkBuilder builder;
  CsvTable table(junctions.string(), read_network_text(junctions), junction_columns, to_si);
  require(table, "id");
  while (table.next()) {
    builder.add(JunctionRow{table.text("id"), table.number("x"), table.number("y"), table.number("z"),
                            table.number("pressure"), table.number("flow"), table.number("resistance")},
                table.where());
  }
  CsvTable rows(vessels.string(), read_network_text(vessels), vessel_columns, to_si);
  for (const char* name : {"id", "from", "to"}) require(rows, name);
  if (rows.has("radius") == rows.has("diameter")) {
    throw InputError(rows.where() + ": give one of the columns radius and diameter");
  }
  while (rows.next()) {
    std::optional<double> radius = rows.number("radius");
    if (const auto diameter = rows.number("diameter")) radius = *diameter / 2;
    builder.add(VesselRow{rows.text("id"), rows.text("from"), rows.text("to"), radius, rows.number("length"),
                          rows.number("wall_thickness"), rows.text("kind"), rows.number("generation")},
                rows.where());
  }
  return builder.finish(vessels.string());
}

}  // namespace rhexis::network
