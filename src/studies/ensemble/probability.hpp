// SPDX-License-Identifier: BSD-3-Clause
/// How often walls rupture, by pressure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "studies/ensemble/sample.hpp"

namespace rhexis::ensemble {

struct Interval {
  double low = 0, high = 1;
};

/// 95 % confidence interval of a probability, from `successes` of `trials` (Wilson 1927,
/// doi:10.1080/01621459.1927.10502953): within 0 and 1, and of use even where none or all succeed.
Interval wilson_interval(std::int64_t successes, std::int64_t trials);

struct Probability {
  double pressure = 0;  ///< Pa
  std::int64_t samples = 0, ruptured = 0;
  std::optional<double> mean_onset = {};  ///< s, of those that ruptured

  double value() const { return static_cast<double>(ruptured) / static_cast<double>(samples); }
  Interval interval() const { return wilson_interval(ruptured, samples); }
};

/// By ascending pressure. `samples` in their order (see `comes_before`), so that sums are the same ones
/// always.
std::vector<Probability> probabilities(const std::vector<Sample>& samples);

/// probability.csv.
std::string probability_table(const std::vector<Probability>& rows);

}  // namespace rhexis::ensemble
