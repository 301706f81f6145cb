// SPDX-License-Identifier: BSD-3-Clause
/// movie.mp4 from a folder of numbered pictures.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace rhexis::output {

/// Makes `movie` through ffmpeg from the largest series `<name>_<digits>.png` (the first by name among
/// equals) of the pictures `names` in the folder `images`. Returns an empty text, or the reason why there is
/// none.
std::string make_movie(const std::filesystem::path& images, const std::vector<std::string>& names,
                       const std::filesystem::path& movie, double frames_per_second);

}  // namespace rhexis::output
