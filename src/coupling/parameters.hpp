// SPDX-License-Identifier: BSD-3-Clause
/// Input keys of the sections coupling, body and cascade.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/parameter.hpp"
#include "coupling/net_pressure.hpp"

namespace rhexis::coupling {

struct Parameters {
  std::string vessel;               ///< "screening": the one at highest risk
  std::string mode = "one_way";     ///< "one_way" | "two_way"
  std::optional<double> window;     ///< s
  std::string resolution = "auto";  ///< "auto" | "paper"

  double tension = 0, atmosphere = 0, compression = 0;  ///< Pa
  std::string compression_axis = "x";
  std::optional<double> compression_from, compression_to;  ///< m

  std::int64_t events = 0;           ///< most vessels of a cascade; 0: one vessel, no cascade
  std::string outcome = "bleeding";  ///< "bleeding" | "occlusion"
  double risk_limit = 1;

  bool screens() const { return vessel == "screening"; }
};

ParameterList declare(Parameters& p);

/// Of the body's section.
Compression compression(const Parameters& p);
/// What acts on every vessel from outside (Pa): without a compression that has a range.
double outside_everywhere(const Parameters& p);

}  // namespace rhexis::coupling
