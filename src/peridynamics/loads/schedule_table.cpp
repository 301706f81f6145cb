// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/loads/schedule_table.hpp"

#include <cstdint>
#include <utility>

#include "core/error.hpp"
#include "core/format.hpp"

namespace rhexis::peridynamics {

std::vector<CurvePoint> schedule_table(const std::string& file, std::string text, const ToSi& to_si) {
  text = plain_text(std::move(text));
  if (text.find('\0') != std::string::npos) throw InputError(file + ": not a text file");
  CsvTable table(file, std::move(text), Columns{{"time", "s"}, {"pressure", "Pa"}}, to_si);
  for (const char* name : {"time", "pressure"})
    if (!table.has(name)) throw InputError(table.where() + ": there is no column " + name);
  const auto number = [&](const char* name) {
    const std::optional<double> value = table.number(name);
    if (!value) throw InputError(table.where() + ": " + name + " is missing");
    return *value;
  };
  std::vector<CurvePoint> points;
  while (table.next()) {
    const CurvePoint point{number("time"), number("pressure")};
    if (point.second < 0)
      throw InputError(table.where() + ": pressure = " + table.text("pressure") + ": must be at least 0");
    if (!points.empty() && point.first <= points.back().first)
      throw InputError(table.where() + ": time = " + table.text("time") +
                       ": times must increase, and before it is " + quantity(points.back().first, "s"));
    points.push_back(point);
  }
  if (points.size() < 2) throw InputError(file + ": at least two rows are needed below the header");
  return points;
}

std::string checksum(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3;
  }
  std::string digits(16, '0');
  for (auto digit = digits.rbegin(); digit != digits.rend(); ++digit, hash >>= 4)
    *digit = "0123456789abcdef"[hash & 15];
  return "fnv1a:" + digits;
}

}  // namespace rhexis::peridynamics
