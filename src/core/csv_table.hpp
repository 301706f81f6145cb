// SPDX-License-Identifier: BSD-3-Clause
/// Tables in CSV files: a header row that names columns and, in brackets, their units; rows of numbers and
/// texts. Commas between fields, points in decimal numbers; fields may stand in double quotes; empty rows and
/// those of a comment (#) are skipped, a byte order mark and carriage returns before line ends too.
#pragma once

#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/error.hpp"

namespace rhexis {

/// What a column may be called, and the SI unit of its numbers ("": text, "1": no unit).
using CsvColumns = std::map<std::string, std::string, std::less<>>;

/// Turns a quantity as written ("1 um") into SI ("m"); throws InputError.
using ToSi = std::function<double(std::string_view text, std::string_view unit)>;

/// Rows of a CSV file, with the header understood. Every error is an InputError that names file and line, and
/// what it is about: the column, the value.
class CsvTable {
 public:
  CsvTable(std::string file, std::string text, const CsvColumns& columns, const ToSi& to_si)
      : file_(std::move(file)), text_(std::move(text)), rest_(text_) {
    if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);
    if (!next()) throw InputError(file_ + ": there is no header row");
    if (fields_.size() == 1 && fields_[0].find_first_of(";\t") != std::string::npos)
      throw InputError(where() + ": fields are divided by " +
                       (fields_[0].find(';') != std::string::npos ? "semicolons" : "tabulators") +
                       ", and commas are needed, with points in decimal numbers: " + shown(fields_[0]));
    for (const std::string& field : fields_) read_header(field, columns, to_si);
  }
  CsvTable(const CsvTable&) = delete;
  CsvTable& operator=(const CsvTable&) = delete;

  /// The next row that is not empty or a comment; false at the end.
  bool next() {
    while (!rest_.empty()) {
      const auto end = rest_.find('\n');
      const std::string_view line = trimmed(rest_.substr(0, end));
      rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
      ++line_;
      if (line.empty() || line.front() == '#') continue;
      split(line);
      if (!names_.empty() && fields_.size() != names_.size()) refuse_length();
      return true;
    }
    return false;
  }

  /// "vessels.csv:3", of the present row.
  std::string where() const { return file_ + ":" + std::to_string(line_); }

  /// A text; empty where there is none or no such column.
  std::string text(std::string_view name) const {
    const auto column = find(name);
    return column == names_.size() ? std::string() : fields_[column];
  }

  /// A number in SI; none where the field is empty or there is no such column.
  std::optional<double> number(std::string_view name) const {
    const auto column = find(name);
    if (column == names_.size() || fields_[column].empty()) return std::nullopt;
    const std::string& field = fields_[column];
    const char* first = field.data() + (field.front() == '+' ? 1 : 0);
    double value = 0;
    const auto [end, error] = std::from_chars(first, field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(value)) {
      const bool decimal_comma = field.find(',') != std::string::npos;
      throw InputError(where() + ": " + std::string(name) + " = " + shown(field) + ": not a finite number" +
                       (decimal_comma ? "; decimal numbers have a point" : ""));
    }
    return value * factors_[column];
  }

  bool has(std::string_view name) const { return find(name) < names_.size(); }

 private:
  static std::string_view trimmed(std::string_view text) {
    const auto begin = text.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
  }

  /// A field, shortened to what a message can hold.
  static std::string shown(const std::string& field) {
    constexpr std::size_t most = 60;
    return field.size() <= most ? field : field.substr(0, most) + "...";
  }

  std::size_t find(std::string_view name) const {
    std::size_t i = 0;
    while (i < names_.size() && names_[i] != name) ++i;
    return i;
  }

  [[noreturn]] void refuse_length() const {
    const char* hint = fields_.size() < names_.size() ? "is the file cut short here?"
                       : fields_.size() == 2 * names_.size()
                           ? "have decimal numbers a comma? they need a point"
                           : "is there a comma too many?";
    throw InputError(where() + ": " + std::to_string(fields_.size()) + " fields, but the header has " +
                     std::to_string(names_.size()) + ": " + hint);
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
        if (!line.empty() && line.front() != ',')
          throw InputError(where() + ": text after a quoted field, \"" + shown(field) + "\": '" +
                           shown(std::string(line.substr(0, line.find(',')))) + "'");
      }
      const auto comma = line.find(',');
      if (field.empty()) field = trimmed(line.substr(0, comma));
      fields_.push_back(std::move(field));
      if (comma == std::string_view::npos) return;
      line.remove_prefix(comma + 1);
    }
  }

  /// "radius [um]": the name, and how many metres one is.
  void read_header(const std::string& field, const CsvColumns& columns, const ToSi& to_si) {
    const auto bracket = field.find('[');
    const std::string name(trimmed(std::string_view(field).substr(0, bracket)));
    const auto known = columns.find(name);
    if (known == columns.end()) {
      std::string all;
      for (const auto& column : columns) all += (all.empty() ? "" : ", ") + column.first;
      throw InputError(where() + ": there is no column '" + shown(name) + "' (columns: " + all + ")");
    }
    if (find(name) < names_.size()) throw InputError(where() + ": two columns are called " + name);
    const std::string& unit = known->second;
    double factor = 1;
    if (!unit.empty() && unit != "1") {
      const auto end = field.find(']');
      if (bracket == std::string::npos || end == std::string::npos)
        throw InputError(where() + ": column " + name + " needs its unit, as in '" + name + " [" + unit +
                         "]'");
      try {
        factor = to_si("1 " + field.substr(bracket + 1, end - bracket - 1), unit);
      } catch (const InputError& error) {
        throw InputError(where() + ": column " + shown(field) + ": " + error.what());
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

}  // namespace rhexis
