// SPDX-License-Identifier: BSD-3-Clause
/// Names of a run's pictures: SERIES_DIGITS.png, as scripts give them.
#pragma once

#include <filesystem>
#include <string>

namespace rhexis::output {

/// The series that a picture belongs to, e.g. "vessel" of images/vessel_000250.png; empty for any other file.
inline std::string picture_series(const std::filesystem::path& path) {
  if (path.extension() != ".png") return {};
  const std::string stem = path.stem().string();
  const std::size_t end = stem.find_last_not_of("0123456789");
  const bool numbered = end != std::string::npos && end + 1 < stem.size() && stem[end] == '_';
  return numbered ? stem.substr(0, end) : std::string{};
}

}  // namespace rhexis::output
