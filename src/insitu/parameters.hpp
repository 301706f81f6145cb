/// Input keys of section insitu.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/parameter.hpp"

namespace rhexis::insitu {

struct Parameters {
  bool enabled = false;
  std::vector<std::string> scripts;
  std::optional<std::int64_t> every_steps;
  std::string renderer;  ///< "auto" | "osmesa" | "egl" | "x11"
};

ParameterList declare(Parameters& p);

}  // namespace rhexis::insitu
