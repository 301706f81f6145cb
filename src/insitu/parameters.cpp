#include "insitu/parameters.hpp"

namespace rhexis::insitu {

ParameterList declare(Parameters& p) {
  return {
      {"insitu.enabled", &p.enabled, "", "true",
       "Make pictures with ParaView Catalyst while the program runs, where scripts are named.", ""},
      {"insitu.scripts", &p.scripts, "", "[]",
       "Catalyst scripts (Python) to run: looked for from the working folder, then from the input file's "
       "folder.",
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
  };
}

}  // namespace rhexis::insitu
