// SPDX-License-Identifier: BSD-3-Clause
#include "studies/ensemble/sample_table.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "core/error.hpp"

namespace rhexis::ensemble {
namespace {

std::string cell(const std::optional<double>& value) {
  return value ? fmt::format("{}", *value) : std::string{};
}

/// Cells of a row, one after the other.
class Cells {
 public:
  explicit Cells(std::string_view row) : rest_(row) {}

  /// Reads the next cell; whether it held all of a number.
  template <class T>
  bool read(T& value) {
    const std::string_view cell = next();
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    return error == std::errc{} && end == cell.data() + cell.size() && !cell.empty();
  }
  bool read(std::optional<double>& value) {
    if (rest_.empty() || rest_.front() == ',') return next().empty();
    return read(value.emplace());
  }
  bool done() const { return done_; }

 private:
  std::string_view next() {
    const std::size_t comma = rest_.find(',');
    const std::string_view cell = rest_.substr(0, comma);
    done_ = comma == std::string_view::npos;
    rest_.remove_prefix(done_ ? rest_.size() : comma + 1);
    return cell;
  }

  std::string_view rest_;
  bool done_ = false;
};

bool makes_sense(const Sample& s) {
  const auto is_time = [](const std::optional<double>& t) { return !t || (std::isfinite(*t) && *t >= 0); };
  const auto is_factor = [](double f) { return std::isfinite(f) && f > 0; };
  return std::isfinite(s.pressure) && s.pressure >= 0 && s.wall >= 0 && is_factor(s.factors.strength) &&
         is_factor(s.factors.thickness) && is_factor(s.factors.stiffness) && is_time(s.onset) &&
         is_time(s.first_break) && std::isfinite(s.max_displacement) && s.max_displacement >= 0 &&
         s.steps >= 0;
}

bool read_row(std::string_view line, Sample& s) {
  Cells cells(line);
  int ruptured = 0;
  const bool read = cells.read(s.pressure) && cells.read(s.wall) && cells.read(s.factors.strength) &&
                    cells.read(s.factors.thickness) && cells.read(s.factors.stiffness) &&
                    cells.read(ruptured) && cells.read(s.onset) && cells.read(s.first_break) &&
                    cells.read(s.max_displacement) && cells.read(s.steps) && cells.done();
  s.ruptured = ruptured == 1;
  return read && (ruptured == 0 || ruptured == 1) && s.ruptured == s.onset.has_value() && makes_sense(s);
}

}  // namespace

const char* const sample_header =
    "pressure_Pa,wall,strength_factor,thickness_factor,stiffness_factor,ruptured,onset_s,first_bond_break_s,"
    "max_displacement_m,steps\n";

std::string row(const Sample& s) {
  return fmt::format("{},{},{},{},{},{},{},{},{},{}\n", s.pressure, s.wall, s.factors.strength,
                     s.factors.thickness, s.factors.stiffness, s.ruptured ? 1 : 0, cell(s.onset),
                     cell(s.first_break), s.max_displacement, s.steps);
}

std::vector<Sample> read_samples(const std::string& text, const std::string& file) {
  std::vector<Sample> samples;
  std::set<std::pair<std::int64_t, double>> met;  // wall and pressure
  std::size_t start = 0;
  for (int line = 1;; ++line) {
    const std::size_t end = text.find('\n', start);
    if (end == std::string::npos) return samples;
    const std::string_view content(text.data() + start, end - start);
    start = end + 1;
    if (line == 1) {
      if (text.compare(0, start, sample_header) != 0)
        throw InputError(fmt::format("{}:1: not the header of an ensemble's samples", file));
      continue;
    }
    Sample sample;
    if (!read_row(content, sample))
      throw InputError(fmt::format("{}:{}: not a sample: '{}'", file, line, content));
    if (!met.emplace(sample.wall, sample.pressure).second)
      throw InputError(fmt::format("{}:{}: a second sample of wall {} under {} Pa", file, line, sample.wall,
                                   sample.pressure));
    samples.push_back(sample);
  }
}

}  // namespace rhexis::ensemble
