// SPDX-License-Identifier: BSD-3-Clause
#include "studies/ensemble/probability.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace rhexis::ensemble {

Interval wilson_interval(std::int64_t successes, std::int64_t trials) {
  constexpr double z = 1.959963984540054;  // leaves 2.5 % on either side
  if (trials == 0) return {};
  const auto n = static_cast<double>(trials);
  const double p = static_cast<double>(successes) / n;
  const double middle = p + z * z / (2 * n);
  const double half = z * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  const double scale = 1 + z * z / n;
  // The ends are exact where round-off could pass them.
  return {successes == 0 ? 0 : (middle - half) / scale, successes == trials ? 1 : (middle + half) / scale};
}

std::vector<Probability> probabilities(const std::vector<Sample>& samples) {
  std::map<double, Probability> by_pressure;
  std::map<double, double> onsets;
  for (const Sample& s : samples) {
    Probability& p = by_pressure[s.pressure];
    p.pressure = s.pressure;
    ++p.samples;
    if (!s.ruptured) continue;
    ++p.ruptured;
    onsets[s.pressure] += *s.onset;
  }
  std::vector<Probability> rows;
  for (auto& [pressure, p] : by_pressure) {
    if (p.ruptured > 0) p.mean_onset = onsets[pressure] / static_cast<double>(p.ruptured);
    rows.push_back(p);
  }
  return rows;
}

std::string probability_table(const std::vector<Probability>& rows) {
  std::string table = "pressure_Pa,samples,ruptured,probability,low_95,high_95,mean_onset_s\n";
  for (const Probability& p : rows) {
    const auto [low, high] = p.interval();
    table += fmt::format("{},{},{},{},{},{},{}\n", p.pressure, p.samples, p.ruptured, p.value(), low, high,
                         p.mean_onset ? fmt::format("{}", *p.mean_onset) : std::string{});
  }
  return table;
}

}  // namespace rhexis::ensemble
