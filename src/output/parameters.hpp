// SPDX-License-Identifier: BSD-3-Clause
/// Input keys of section output.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/parameter.hpp"
#include "output/series_plan.hpp"

namespace rhexis::output {

/// What output.format asks for.
enum class StoredAs { xdmf, vtkhdf, both };

constexpr auto name_table(StoredAs) {
  using enum StoredAs;
  return std::to_array<Named<StoredAs>>({{xdmf, "xdmf"}, {vtkhdf, "vtkhdf"}, {both, "both"}});
}

struct Parameters {
  std::optional<std::int64_t> every_steps;
  std::optional<double> every_time;  ///< s
  std::vector<std::string> fields;
  Precision precision = Precision::single_precision;
  StoredAs format = StoredAs::xdmf;
  std::int64_t checkpoint_every = 0;
  bool movie = true;
  double frames_per_second = 12;
};

/// The keys, bound to `p`; output.fields lists the `usual` names unless others of the `known` ones are given.
ParameterList declare(Parameters& p, std::vector<std::string> usual, std::vector<std::string> known);

/// The one key, of those, that says how a network is stored as well.
Parameter declare_format(Parameters& p);

/// What the keys say of a series.
std::vector<SeriesFormat> formats_of(const Parameters& p);

/// Steps at which output is due, ascending, with the first (0) and the last (`steps`). Throws InputError
/// where every_steps and every_time are both given.
std::vector<long> planned_steps(const Parameters& p, long steps, double time_step);

}  // namespace rhexis::output
