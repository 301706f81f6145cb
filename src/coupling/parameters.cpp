#include "coupling/parameters.hpp"

namespace rhexis::coupling {

ParameterList declare(Parameters& p) {
  return {
      {"coupling.vessel",
       &p.vessel,
       "",
       {},
       "The vessel whose wall is simulated: its path in a tree (\"artery.0110\"), its id, its name in a "
       "file, or \"screening\": the one at highest risk.",
       "Sec. 3.3"},
      {"coupling.mode",
       &p.mode,
       "",
       "\"one_way\"",
       "one_way: the network loads the wall, as in the paper; two_way: the wall's lumen and leak change the "
       "network as well.",
       "Sec. 3.3",
       {},
       {"one_way", "two_way"}},
      only_with(
          {"coupling.mode", {"\"two_way\""}},
          {"coupling.window", &p.window, "s", "\"auto\"",
           "Time between exchanges with the network where mode is two_way; \"auto\" is a two-hundredth of "
           "time.end.",
           "", Range::positive()}),
      {"coupling.resolution",
       &p.resolution,
       "",
       "\"auto\"",
       "paper: discretisation.particles for the whole vessel; auto: as the paper, but where that leaves "
       "fewer "
       "than 4 spacings across the wall, only the middle piece that so many particles fill at 5 across.",
       "Sec. 3.3",
       {},
       {"auto", "paper"}},

      {"cascade.events", &p.events, "1", "0",
       "After a vessel has ruptured the flow is found again, and the vessel that is now at highest risk is "
       "simulated "
       "next: this many at most; 0: only coupling.vessel. Needs an explicit network.",
       "", Range::between(0, 1000)},
      only_with({"cascade.events", {}}, {"cascade.outcome",
                                         &p.outcome,
                                         "",
                                         "\"bleeding\"",
                                         "What a ruptured vessel does from then on: it bleeds through the "
                                         "opening that it had at the end, or "
                                         "it "
                                         "is "
                                         "occluded (a clot, a clamp, a spasm) and the others carry its flow.",
                                         "",
                                         {},
                                         {"bleeding", "occlusion"}}),
      only_with({"cascade.events", {}},
                {"cascade.risk_limit", &p.risk_limit, "1", "1",
                 "The cascade ends when no vessel's risk (strain over critical stretch) is above this.", "",
                 Range::positive()}),

      {"body.tissue_tension", &p.tension, "Pa", "\"0 Pa\"", "Pressure of the tissue around the vessel, P_t.",
       "Eq. (7)", Range::any()},
      {"body.atmosphere", &p.atmosphere, "Pa", "\"0 Pa\"",
       "Atmospheric pressure around the body, P_atm, over that to which the network's pressures are "
       "relative.",
       "Eq. (7)", Range::any()},
      {"body.compression", &p.compression, "Pa", "\"0 Pa\"",
       "Pressure of a cuff or g-suit on the vessel, P_comp.", "Eq. (7)", Range::not_negative()},
      only_with({"body.compression", {}}, {"body.compression_axis",
                                           &p.compression_axis,
                                           "",
                                           "\"x\"",
                                           "Axis along which the compression's range is measured.",
                                           "",
                                           {},
                                           {"x", "y", "z"}}),
      only_with({"body.compression", {}},
                {"body.compression_from", &p.compression_from, "m", "\"auto\"",
                 "Where the compressed part of the body begins along that axis; \"auto\": everywhere.", "",
                 Range::any()}),
      only_with({"body.compression", {}}, {"body.compression_to", &p.compression_to, "m", "\"auto\"",
                                           "Where it ends.", "", Range::any()}),
  };
}

Compression compression(const Parameters& p) {
  Compression c;
  c.pressure = p.compression;
  c.axis = p.compression_axis[0] - 'x';
  c.from = p.compression_from.value_or(c.from);
  c.to = p.compression_to.value_or(c.to);
  return c;
}

double outside_everywhere(const Parameters& p) {
  PressureParts parts;
  parts.tension = p.tension;
  parts.atmosphere = p.atmosphere;
  if (!p.compression_from && !p.compression_to) parts.compression = p.compression;
  return parts.outside();
}

}  // namespace rhexis::coupling
