// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <initializer_list>

#include "core/csv_table.hpp"
#include "core/error.hpp"
#include "network/files/network_file.hpp"

namespace rhexis::network {
namespace {

CsvOptions csv_options(const FileOptions& options) {
  return {.skips_other_columns = true,
          .length_unit = options.length_unit,
          .length_unit_hint = ", or network.file_length_unit"};
}

/// What else the header has, to end a message that a column is missing.
std::string others_of(const CsvTable& table) {
  const std::vector<std::string>& others = table.skipped();
  return others.empty() ? "" : fmt::format("; columns that are not known: {}", fmt::join(others, ", "));
}

/// Throws InputError where one of the columns is missing.
void require(const CsvTable& table, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (!table.has(name)) throw InputError(table.where() + ": there is no column " + name + others_of(table));
}

/// Reads rows to the end of the table by `read`; whether all were rows.
template <class Read>
bool each_row(CsvTable& table, NetworkBuilder& builder, const Read& read) {
  bool more = true, all = true;
  while (more) {
    const bool is_row = builder.faults().collect([&] { more = table.next(); });
    if (is_row && more) read();
    all = all && is_row;
  }
  return all;
}

/// Throws InputError for a table that is one of vessels.
void refuse_vessels(const CsvTable& junctions) {
  const auto has = [&](const char* name) {
    return std::ranges::any_of(junctions.skipped(), [&](const std::string& heading) {
      const Column* column = find_column(vessel_columns(), parsed_heading(heading).name);
      return column != nullptr && column->name == name;
    });
  };
  if (has("from") && has("to"))
    throw InputError(junctions.where() +
                     ": a table of vessels; network.files names that of the junctions first");
}

void read_junctions(const std::filesystem::path& file, const FileOptions& options, NetworkBuilder& builder) {
  CsvTable table(file.string(), read_network_text(file), junction_columns(), options.to_si,
                 csv_options(options));
  refuse_vessels(table);
  require(table, {"id"});
  if (!each_row(table, builder, [&] { builder.add_junction(table); })) builder.lose_junction();
  builder.note_ignored(file.string(), "columns", table.skipped());
  if (table.uses_length_unit()) builder.use_length_unit();
}

void read_vessels(const std::filesystem::path& file, const FileOptions& options, NetworkBuilder& builder) {
  CsvTable table(file.string(), read_network_text(file), vessel_columns(), options.to_si,
                 csv_options(options));
  require(table, {"id", "from", "to"});
  if (table.has("radius") == table.has("diameter"))
    throw InputError(table.where() + ": give one of the columns radius and diameter" + others_of(table));
  each_row(table, builder, [&] { builder.add_vessel(table, static_cast<std::uint32_t>(table.line())); });
  builder.note_ignored(file.string(), "columns", table.skipped());
  if (table.uses_length_unit()) builder.use_length_unit();
}

}  // namespace

BoundedGraph read_csv_network(const std::filesystem::path& junctions, const std::filesystem::path& vessels,
                              const FileOptions& options) {
  NetworkBuilder builder(options);
  if (!builder.faults().collect([&] { read_junctions(junctions, options, builder); }))
    builder.lose_junction();
  builder.faults().collect([&] { read_vessels(vessels, options, builder); });
  return builder.finish(vessels.string());
}

}  // namespace rhexis::network
