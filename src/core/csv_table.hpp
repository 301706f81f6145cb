// SPDX-License-Identifier: BSD-3-Clause
/// Tables in CSV files: a header row that names columns and, in brackets, their units; rows of numbers and
/// texts. Fields are divided by commas, semicolons or tabs, whichever the header has; with the latter two,
/// decimal numbers may have a comma instead of the point. Fields may stand in double quotes; empty rows and
/// those of a comment (#) are skipped. Names are known in any case, with blanks or underscores
/// (core/heading.hpp), the text in any encoding that core/text_encoding.hpp knows.
#pragma once

#include <algorithm>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/faults.hpp"
#include "core/heading.hpp"
#include "core/scanning.hpp"
#include "core/text_encoding.hpp"

namespace rhexis {

struct CsvOptions {
  /// Columns that are not known are skipped, and `skipped()` names them; else they are refused.
  bool skips_other_columns = false;
  std::string length_unit = {};  ///< of lengths whose heading tells none; empty: each heading has to tell it
  std::string length_unit_hint =
      {};  ///< how else a length may get its unit, to end the message that it has none
};

/// Rows of a CSV file, with the header understood. Every error is an InputError that names file and line, and
/// what it is about: the column, the value.
class CsvTable {
 public:
  CsvTable(std::string file, std::string text, Columns columns, const ToSi& to_si, CsvOptions options = {})
      : file_(std::move(file)),
        text_(plain_text(std::move(text))),
        rest_(text_),
        columns_(std::move(columns)),
        options_(std::move(options)) {
    if (!next_line()) throw InputError(file_ + ": there is no header row");
    if (line_text_.size() == 5 && line_text_.starts_with("sep=")) {  // as Excel writes it
      separator_ = line_text_[4];
      if (!next_line()) throw InputError(file_ + ": there is no header row");
    } else {
      separator_ = separator_of(line_text_);
    }
    split();
    Faults faults;
    for (const std::string_view field : fields_)
      faults.collect([&] { read_heading(std::string(field), to_si); });
    faults.raise();
  }
  CsvTable(const CsvTable&) = delete;
  CsvTable& operator=(const CsvTable&) = delete;

  /// The next row that is not empty or a comment; false at the end.
  bool next() {
    while (next_line()) {
      split();
      if (std::ranges::all_of(fields_, &std::string_view::empty)) continue;
      while (fields_.size() > headings_.size() && fields_.back().empty()) fields_.pop_back();
      if (fields_.size() != headings_.size()) refuse_length();
      return true;
    }
    return false;
  }

  /// "vessels.csv:3", of the present row.
  std::string where() const { return file_ + ":" + std::to_string(line_); }

  /// The number of the present row's line in the file, from 1.
  std::size_t line() const { return line_; }

  /// A text; empty where there is none or no such column.
  std::string text(std::string_view name) const {
    const auto column = find(name);
    return column == headings_.size() ? std::string() : std::string(fields_[column]);
  }

  /// A number in SI; none where the field is empty or there is no such column.
  std::optional<double> number(std::string_view name) {
    const auto column = find(name);
    if (column == headings_.size() || fields_[column].empty()) return std::nullopt;
    const std::optional<double> value = parsed(name, fields_[column]);
    if (!value) {
      const bool decimal_comma = separator_ == ',' && fields_[column].find(',') != std::string_view::npos;
      throw InputError(where() + ": " + std::string(name) + " = " + shown(fields_[column]) +
                       ": not a finite number" + (decimal_comma ? "; decimal numbers have a point" : ""));
    }
    return *value * headings_[column].factor;
  }

  bool has(std::string_view name) const { return find(name) < headings_.size(); }

  /// Headings, as written, of the columns that are skipped.
  const std::vector<std::string>& skipped() const { return skipped_; }

  /// Whether a column of lengths has taken its unit from the options.
  bool uses_length_unit() const { return uses_length_unit_; }

 private:
  /// A column of the file: the known one that it is, or null, and what turns its numbers into SI.
  struct FileColumn {
    const Column* column;
    double factor;
  };

  /// A field, shortened to what a message can hold.
  static std::string shown(std::string_view field) {
    constexpr std::size_t most = 60;
    std::string text(field.substr(0, most));
    if (field.size() > most) text += "...";
    return text;
  }

  /// What divides the fields of a header: the one of comma, semicolon and tab that is found most often.
  static char separator_of(std::string_view header) {
    char best = ',';
    std::ptrdiff_t most = 0;
    for (const char candidate : {',', ';', '\t'}) {
      const std::ptrdiff_t found = std::ranges::count(header, candidate);
      if (found > most) {
        best = candidate;
        most = found;
      }
    }
    return best;
  }

  std::size_t find(std::string_view name) const {
    std::size_t i = 0;
    while (i < headings_.size() && (headings_[i].column == nullptr || headings_[i].column->name != name)) ++i;
    return i;
  }

  /// Goes to the next line that is not empty or a comment; false at the end.
  bool next_line() {
    while (!rest_.empty()) {
      const auto end = rest_.find('\n');
      line_text_ = rest_.substr(0, end);
      rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
      ++line_;
      const std::string_view content = without_blanks(line_text_);
      if (content.empty() || content.front() == '#') continue;
      if (line_text_.ends_with('\r')) line_text_.remove_suffix(1);
      return true;
    }
    return false;
  }

  [[noreturn]] void refuse_length() const {
    const char* hint = fields_.size() < headings_.size() ? "is the file cut short here?"
                       : separator_ == ',' && fields_.size() == 2 * headings_.size()
                           ? "have decimal numbers a comma? they need a point, or semicolons between fields"
                           : "is there a comma too many?";
    throw InputError(where() + ": " + std::to_string(fields_.size()) + " fields, but the header has " +
                     std::to_string(headings_.size()) + ": " + hint);
  }

  /// The number of a field, in the unit of its heading; none where it is not a finite one.
  std::optional<double> parsed(std::string_view name, std::string_view field) {
    std::string with_point;
    if (separator_ != ',') {
      const char mark = field.find(',') != std::string_view::npos   ? ','
                        : field.find('.') != std::string_view::npos ? '.'
                                                                    : '\0';
      if (mark != '\0' && decimal_mark_ == '\0') decimal_mark_ = mark;
      if (mark != '\0' && mark != decimal_mark_) {
        throw InputError(
            where() + ": " + std::string(name) + " = " + shown(field) + ": other numbers of the table have " +
            (decimal_mark_ == ',' ? "a decimal comma" : "a decimal point") + ", this one has not");
      }
      if (mark == ',') {
        with_point = field;
        with_point[with_point.find(',')] = '.';
        field = with_point;
      }
    }
    return finite_number(field);
  }

  /// Cuts the line into fields without blanks around them.
  void split() {
    fields_.clear();
    unescaped_.clear();
    std::string_view line = line_text_;
    while (true) {
      auto end = line.find(separator_);
      std::string_view field = without_blanks(line.substr(0, end));
      if (field.starts_with('"')) {
        line.remove_prefix(static_cast<std::size_t>(field.data() - line.data()));
        field = quoted(line);
        end = line.find(separator_);
        if (const std::string_view after = without_blanks(line.substr(0, end)); !after.empty())
          throw InputError(where() + ": text after a quoted field, \"" + shown(field) + "\": '" +
                           shown(after) + "'");
      }
      fields_.push_back(field);
      if (end == std::string_view::npos) return;
      line.remove_prefix(end + 1);
    }
  }

  /// What stands in the double quotes that `line` begins with; takes it off the line.
  std::string_view quoted(std::string_view& line) {
    const std::string_view whole = line;
    bool has_quotes_inside = false;
    std::size_t end = 1;
    for (; end < line.size(); ++end) {
      if (line[end] != '"') continue;
      if (end + 1 == line.size() || line[end + 1] != '"') break;
      has_quotes_inside = true;
      ++end;
    }
    if (end >= line.size()) throw InputError(where() + ": a quoted field does not end");
    line.remove_prefix(end + 1);
    const std::string_view inside = whole.substr(1, end - 1);
    if (!has_quotes_inside) return inside;
    std::string& text = unescaped_.emplace_back();
    for (std::size_t i = 0; i < inside.size(); ++i) {
      text += inside[i];
      if (inside[i] == '"') ++i;
    }
    return text;
  }

  void read_heading(const std::string& field, const ToSi& to_si) {
    headings_.push_back({nullptr, 1});
    const Heading heading = parsed_heading(field);
    const Column* column = find_column(columns_, heading.name);
    if (column == nullptr && options_.skips_other_columns) {
      if (!field.empty()) skipped_.push_back(shown(field));
      return;
    }
    if (column == nullptr)
      throw InputError(where() + ": there is no column '" + shown(heading.name) +
                       "' (columns: " + names_of(columns_) + ")");
    if (has(column->name)) throw InputError(where() + ": two columns are called " + column->name);
    headings_.back() = {column, factor_of(*column, heading, field, to_si)};
  }

  double factor_of(const Column& column, const Heading& heading, const std::string& field,
                   const ToSi& to_si) {
    UnitOfColumn unit;
    try {
      unit = unit_of(column, heading, options_.length_unit, to_si);
    } catch (const InputError& error) {
      throw InputError(where() + ": column " + shown(field) + ": " + error.what());
    }
    if (!unit.factor)
      throw InputError(where() + ": column " + column.name + " needs its unit, as in '" + column.name + " [" +
                       column.unit + "]'" + (column.unit == "m" ? options_.length_unit_hint : ""));
    uses_length_unit_ = uses_length_unit_ || unit.is_the_length_unit;
    return *unit.factor;
  }

  std::string file_, text_;
  std::string_view rest_, line_text_;
  std::size_t line_ = 0;
  Columns columns_;
  CsvOptions options_;
  char separator_ = ',';
  char decimal_mark_ = '\0';  ///< of the numbers so far; 0: none had one
  std::vector<std::string_view> fields_;
  std::deque<std::string> unescaped_;  ///< fields that had quotes in quotes
  std::vector<FileColumn> headings_;
  std::vector<std::string> skipped_;
  bool uses_length_unit_ = false;
};

}  // namespace rhexis
