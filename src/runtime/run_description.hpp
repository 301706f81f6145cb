// SPDX-License-Identifier: BSD-3-Clause
/// What is run, for the header, run.json and the pictures.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "runtime/pictures.hpp"

namespace rhexis::runtime {

struct RunDescription {
  std::string file, title;
  std::shared_ptr<const nlohmann::ordered_json> input;  ///< as resolved, for run.json
  PicturesPlan pictures = {};
  bool movie = false;
  double frames_per_second = 0;  ///< frame rate of the movie
};

}  // namespace rhexis::runtime
