#include "insitu/parameters.hpp"

namespace rhexis::insitu {

ParameterList declare(Parameters& p) {
  return {
      {"insitu.enabled", &p.enabled, "", "true",
       "Make pictures with ParaView Catalyst while the program runs, where scripts are named.", ""},
      {"insitu.scripts", &p.scripts, "", "[]",
       "Catalyst scripts (Python) to run: \"vessel\", \"network\", \"coupled\" are Rhexis's own; a path "
       "(my.py) is "
       "looked for from the working folder, then from the input file's folder.",
       ""},
      only_with({"insitu.scripts", {}},
                {"insitu.every_steps", &p.every_steps, "1", "\"auto\"",
                 "Steps between pictures; \"auto\": at every output.", "", Range::at_least(1)}),
      only_with({"insitu.scripts", {}}, {"insitu.renderer",
                                         &p.renderer,
                                         "",
                                         "\"auto\"",
                                         "Who draws: osmesa (no display needed), egl (no display needed), "
                                         "x11 (a display); auto tries them in this order.",
                                         "",
                                         {},
                                         {"auto", "osmesa", "egl", "x11"}}),
      only_with({"insitu.scripts", {}},
                {"insitu.time_limit", &p.time_limit, "s", "\"10 min\"",
                 "How long a script may take for the pictures of one step before the run ends with an error.",
                 "", Range::positive()}),
      only_with({"insitu.scripts", {}},
                {"insitu.live", &p.live, "", "\"\"",
                 "Where a ParaView listens to watch the run (Catalyst > Connect), as host:port, e.g. "
                 "\"localhost:22222\"; empty: nowhere. Nobody has to listen.",
                 ""}),
  };
}

}  // namespace rhexis::insitu
