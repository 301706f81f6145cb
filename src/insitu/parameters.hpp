// SPDX-License-Identifier: BSD-3-Clause
/// Input keys of section insitu.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/parameter.hpp"
#include "insitu/pipeline.hpp"

namespace rhexis::insitu {

struct Parameters {
  bool enabled = true;
  std::vector<std::string> scripts;
  std::optional<std::int64_t> every_steps;
  Renderer renderer = Renderer::automatic;
  double time_limit = 600;  ///< s, of one script at one picture
  std::string live;         ///< "host:port"; empty: nobody is told
};

ParameterList declare(Parameters& p);

}  // namespace rhexis::insitu
