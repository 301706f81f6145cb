// SPDX-License-Identifier: BSD-3-Clause
#include "output/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.hpp"
#include "core/format.hpp"

namespace rhexis::output {

ParameterList declare(Parameters& p, std::vector<std::string> usual, std::vector<std::string> known) {
  p.fields = std::move(usual);
  return {
      {.key = "output.every_steps",
       .target = &p.every_steps,
       .unit = "1",
       .meaning = "Steps between outputs (history, particles, and pictures unless insitu.every_steps says "
                  "otherwise); \"auto\" gives 90 outputs.",
       .range = Range::at_least(1)},
      {.key = "output.every_time",
       .target = &p.every_time,
       .unit = "s",
       .meaning = "Simulated time between outputs, instead of every_steps.",
       .range = Range::positive()},
      {.key = "output.fields",
       .target = &p.fields,
       .meaning =
           "Fields stored of every particle beside its position; an empty list stores no particles. Those of "
           "stress and stretch are known of laws by deformation gradient.",
       .source = "Sec. 3.4",
       .choices = std::move(known)},
      {.key = "output.precision", .target = &p.precision, .meaning = "Of the values stored of particles."},
      declare_format(p),
      {.key = "output.checkpoint_every",
       .target = &p.checkpoint_every,
       .unit = "1",
       .meaning = "Steps between checkpoints for --restart; 0: only when a run is interrupted. A cascade "
                  "leaves one after each event, too.",
       .range = Range::not_negative()},
      {.key = "output.movie",
       .target = &p.movie,
       .meaning = "Make movie.mp4 of the pictures at the end (needs ffmpeg)."},
      {.key = "output.frames_per_second",
       .target = &p.frames_per_second,
       .unit = "1",
       .meaning = "Of the movie.",
       .range = Range::between(1, 120),
       .only_with = {{"output.movie", {"true"}}}},
  };
}

Parameter declare_format(Parameters& p) {
  return {
      .key = "output.format",
      .target = &p.format,
      .meaning =
          "How particles and networks are stored: as particles.h5 and network.h5 with .xdmf files beside "
          "them, which ParaView reads in any version; as particles.vtkhdf and network.vtkhdf, poly data over "
          "time, which it reads from version 5.12 on (Debian 13 has 5.13, Debian 12 has 5.11); or as both."};
}

std::vector<SeriesFormat> formats_of(const Parameters& p) {
  std::vector<SeriesFormat> formats;
  if (p.format != StoredAs::vtkhdf) formats.push_back(SeriesFormat::xdmf);
  if (p.format != StoredAs::xdmf) formats.push_back(SeriesFormat::vtkhdf);
  return formats;
}

std::vector<long> planned_steps(const Parameters& p, long steps, double time_step) {
  if (p.every_steps && p.every_time) {
    throw InputError("give either output.every_steps or output.every_time, not both", "output.every_time");
  }
  constexpr double most_outputs = 1e5;
  double outputs = 0;
  if (p.every_steps) outputs = static_cast<double>(steps) / static_cast<double>(*p.every_steps);
  if (p.every_time) outputs = static_cast<double>(steps) * time_step / *p.every_time;
  if (outputs > most_outputs) {
    throw InputError("this makes " + text(outputs) + " outputs; at most 100000 are possible",
                     p.every_time ? "output.every_time" : "output.every_steps");
  }
  std::vector<long> plan;
  if (p.every_time) {
    for (long k = 0;; ++k) {
      // The first step at or after the time asked for; round-off must not push it one step on.
      const double exact = static_cast<double>(k) * *p.every_time / time_step;
      if (exact - 1e-6 > static_cast<double>(steps - 1)) break;
      const long step = static_cast<long>(std::ceil(exact - 1e-6));
      if (plan.empty() || step > plan.back()) plan.push_back(step);
    }
  } else {
    const long every = p.every_steps ? static_cast<long>(*p.every_steps) : std::max(1L, (steps + 89) / 90);
    for (long step = 0; step < steps; step += every) plan.push_back(step);
  }
  plan.push_back(steps);
  return plan;
}

}  // namespace rhexis::output
