// SPDX-License-Identifier: BSD-3-Clause
#include "insitu/parameters.hpp"

namespace rhexis::insitu {

ParameterList declare(Parameters& p) {
  return {
      {.key = "insitu.enabled",
       .target = &p.enabled,
       .meaning = "Make pictures with ParaView Catalyst while the program runs, where scripts are named."},
      {.key = "insitu.scripts",
       .target = &p.scripts,
       .meaning = "Catalyst scripts (Python) to run: \"vessel\", \"network\", \"coupled\" are Rhexis's own; "
                  "a path (my.py) is looked for from the working folder, then from the input file's folder."},
      {.key = "insitu.every_steps",
       .target = &p.every_steps,
       .unit = "1",
       .meaning = "Steps between pictures; \"auto\": at every output.",
       .range = Range::at_least(1),
       .only_with = {{"insitu.scripts", {}}}},
      {.key = "insitu.renderer",
       .target = &p.renderer,
       .meaning = "Who draws: osmesa (no display needed), egl (no display needed), x11 (a display); auto "
                  "tries them in this order.",
       .only_with = {{"insitu.scripts", {}}}},
      {.key = "insitu.time_limit",
       .target = &p.time_limit,
       .unit = "s",
       .default_in = "min",
       .meaning =
           "How long a script may take for the pictures of one step before the run ends with an error.",
       .range = Range::positive(),
       .only_with = {{"insitu.scripts", {}}}},
      {.key = "insitu.live",
       .target = &p.live,
       .meaning = "Where a ParaView listens to watch the run (Catalyst > Connect), as host:port, e.g. "
                  "\"localhost:22222\"; empty: nowhere. Nobody has to listen.",
       .only_with = {{"insitu.scripts", {}}}},
  };
}

}  // namespace rhexis::insitu
