// SPDX-License-Identifier: BSD-3-Clause
#include "output/kept_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "core/error.hpp"
#include "core/text_file.hpp"

namespace rhexis::output {
namespace {

/// Whether the cell is empty or a finite number, which is left in `value`.
bool read_cell(std::string_view cell, double& value) {
  if (cell.empty()) return true;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc{} && end == cell.data() + cell.size() && std::isfinite(value);
}

/// What is wrong with a row, or nothing; `first` is the first cell, of the row before and then of this one.
std::string fault_of(std::string_view row, std::ptrdiff_t cells, double& first) {
  if (std::ranges::count(row, ',') + 1 != cells) return fmt::format("it should have {} cells", cells);
  const double before = first;
  first = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t start = 0, number = 1; start <= row.size(); ++number) {
    const std::size_t end = std::min(row.find(',', start), row.size());
    double value = 0;
    if (!read_cell(row.substr(start, end - start), value))
      return fmt::format("cell {} is no finite number", number);
    if (number == 1 && end > start) first = value;
    start = end + 1;
  }
  return first > before ? "" : "its first cell should be above that of the row before";
}

}  // namespace

std::string kept_rows(const std::filesystem::path& path, const std::string& header,
                      const std::function<bool(double)>& keeps) {
  std::string kept = header + '\n';
  if (!std::filesystem::exists(path)) return kept;
  const std::string text = whole_file(path);
  if (!text.starts_with(kept))
    throw InputError(
        fmt::format("{}:1: not a table that this run could continue: its first line should be '{}'",
                    path.string(), header));
  const auto cells = std::ranges::count(header, ',') + 1;
  double first = -std::numeric_limits<double>::infinity();
  std::size_t start = kept.size();
  for (int line = 2;; ++line) {
    const std::size_t end = text.find('\n', start);
    if (end == std::string::npos) return kept;
    const std::string_view row(text.data() + start, end - start);
    start = end + 1;
    if (const std::string fault = fault_of(row, cells, first); !fault.empty())
      throw InputError(
          fmt::format("{}:{}: a damaged row: {}: '{}'", path.string(), line, fault, row.substr(0, 80)));
    if (keeps(first)) kept.append(row).push_back('\n');
  }
}

}  // namespace rhexis::output
