#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <map>
#include <string_view>

#include "core/error.hpp"
#include "network/network_file.hpp"

namespace rhexis::network {
namespace {

/// What a column may be called, and the SI unit of its numbers ("": text, "1": no unit).
using Columns = std::map<std::string, std::string, std::less<>>;

const Columns junction_columns{{"id", ""},
                               {"x", "m"},
                               {"y", "m"},
                               {"z", "m"},
                               {"pressure", "Pa"},
                               {"flow", "m3/s"},
                               {"resistance", "Pa s/m3"}};
const Columns vessel_columns{{"id", ""},
                             {"from", ""},
                             {"to", ""},
                             {"radius", "m"},
                             {"diameter", "m"},
                             {"length", "m"},
                             {"wall_thickness", "m"},
                             {"kind", ""},
                             {"generation", "1"}};

std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

/// Rows of a CSV file, with the header understood.
class Table {
 public:
  Table(const std::filesystem::path& file, const Columns& columns, const ToSi& to_si)
      : file_(file.string()), text_(read_network_text(file)), rest_(text_) {
    if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);
    if (!next()) throw InputError(file_ + ": there is no header row");
    for (const std::string& field : fields_) read_header(field, columns, to_si);
  }

  /// The next row that is not empty or a comment; false at the end.
  bool next() {
    while (!rest_.empty()) {
      const auto end = rest_.find('\n');
      const std::string_view line = trimmed(rest_.substr(0, end));
      rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
      ++line_;
      if (line.empty() || line.front() == '#') continue;
      split(line);
      if (!names_.empty() && fields_.size() != names_.size()) {
        throw InputError(fmt::format(
            "{}: {} fields, but the header has {}: {}", where(), fields_.size(), names_.size(),
            fields_.size() < names_.size() ? "is the file cut short here?" : "is there a comma too many?"));
      }
      return true;
    }
    return false;
  }

  std::string where() const { return fmt::format("{}:{}", file_, line_); }

  /// A text; empty where there is none or no such column.
  std::string text(std::string_view name) const {
    const auto column = find(name);
    return column == names_.size() ? std::string() : fields_[column];
  }

  std::optional<double> number(std::string_view name) const {
    const auto column = find(name);
    if (column == names_.size() || fields_[column].empty()) return std::nullopt;
    const std::string& field = fields_[column];
    const char* first = field.data() + (field.front() == '+' ? 1 : 0);
    double value = 0;
    const auto [end, error] = std::from_chars(first, field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(value)) {
      throw InputError(fmt::format("{}: {} = {}: not a finite number", where(), name, field));
    }
    return value * factors_[column];
  }

  bool has(std::string_view name) const { return find(name) < names_.size(); }

 private:
  std::size_t find(std::string_view name) const {
    std::size_t i = 0;
    while (i < names_.size() && names_[i] != name) ++i;
    return i;
  }

  void split(std::string_view line) {
    fields_.clear();
    while (true) {
      line = trimmed(line);
      std::string field;
      if (line.starts_with('"')) {
        std::size_t i = 1;
        for (; i < line.size(); ++i) {
          if (line[i] == '"' && (i + 1 == line.size() || line[i + 1] != '"')) break;
          if (line[i] == '"') ++i;
          field += line[i];
        }
        if (i >= line.size()) throw InputError(where() + ": a quoted field does not end");
        line = trimmed(line.substr(i + 1));
        if (!line.empty() && line.front() != ',') {
          throw InputError(fmt::format("{}: text after a quoted field, \"{}\": '{}'", where(), field,
                                       line.substr(0, line.find(','))));
        }
      }
      const auto comma = line.find(',');
      if (field.empty()) field = trimmed(line.substr(0, comma));
      fields_.push_back(std::move(field));
      if (comma == std::string_view::npos) return;
      line.remove_prefix(comma + 1);
    }
  }

  /// "radius [um]": the name, and how many metres one is.
  void read_header(const std::string& field, const Columns& columns, const ToSi& to_si) {
    const auto bracket = field.find('[');
    const std::string name(trimmed(std::string_view(field).substr(0, bracket)));
    const auto known = columns.find(name);
    if (known == columns.end()) {
      std::string all;
      for (const auto& column : columns) all += (all.empty() ? "" : ", ") + column.first;
      throw InputError(fmt::format("{}: there is no column '{}' (columns: {})", where(), name, all));
    }
    if (find(name) < names_.size())
      throw InputError(fmt::format("{}: two columns are called {}", where(), name));
    const std::string& unit = known->second;
    double factor = 1;
    if (!unit.empty() && unit != "1") {
      const auto end = field.find(']');
      if (bracket == std::string::npos || end == std::string::npos) {
        throw InputError(
            fmt::format("{}: column {} needs its unit, as in '{} [{}]'", where(), name, name, unit));
      }
      try {
        factor = to_si("1 " + field.substr(bracket + 1, end - bracket - 1), unit);
      } catch (const InputError& error) {
        throw InputError(fmt::format("{}: column {}: {}", where(), field, error.what()));
      }
    }
    names_.push_back(name);
    factors_.push_back(factor);
  }

  std::string file_, text_;
  std::string_view rest_;
  std::size_t line_ = 0;
  std::vector<std::string> fields_, names_;
  std::vector<double> factors_;
};

void require(const Table& table, const std::string& name) {
  if (!table.has(name)) throw InputError(fmt::format("{}: there is no column {}", table.where(), name));
}

}  // namespace

BoundedGraph read_csv_network(const std::filesystem::path& junctions, const std::filesystem::path& vessels,
                              const ToSi& to_si) {
  NetworkBuilder builder;
  Table table(junctions, junction_columns, to_si);
  require(table, "id");
  while (table.next()) {
    builder.add(JunctionRow{table.text("id"), table.number("x"), table.number("y"), table.number("z"),
                            table.number("pressure"), table.number("flow"), table.number("resistance")},
                table.where());
  }
  Table rows(vessels, vessel_columns, to_si);
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
