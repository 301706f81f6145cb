// SPDX-License-Identifier: BSD-3-Clause
#include "network/parameters.hpp"

namespace rhexis::network {
namespace {

ParameterList declare(WallParameters& p) {
  const char* rule =
      "Wall thickness over lumen radius: constant (\"ratio\"), or falling with the radius as in arteries "
      "(\"radius\": 0.12 in the aorta, 0.26 at 1.5 mm, 0.41 at 20 um). Of ";
  return {
      {.key = "wall.artery_rule",
       .target = &p.artery.rule,
       .meaning = std::string(rule) + "arteries.",
       .source = "Boileau et al. 2015"},
      {.key = "wall.artery_ratio",
       .target = &p.artery.ratio,
       .unit = "1",
       .meaning = "Wall thickness over lumen radius of arteries, for the rule \"ratio\".",
       .source = "Table 2",
       .range = Range::positive(),
       .only_with = {when("wall.artery_rule", WallRule::ratio)}},
      {.key = "wall.vein_rule",
       .target = &p.vein.rule,
       .meaning = std::string(rule) + "veins.",
       .source = "Boileau et al. 2015"},
      {.key = "wall.vein_ratio",
       .target = &p.vein.ratio,
       .unit = "1",
       .meaning = "The same of veins, for the rule \"ratio\".",
       .source = "Burton 1954 (vena cava: 1.5 mm at 30 mm)",
       .range = Range::positive(),
       .only_with = {when("wall.vein_rule", WallRule::ratio)}},
      {.key = "wall.young_modulus",
       .target = &p.young_modulus,
       .unit = "Pa",
       .default_in = "MPa",
       .meaning = "Young's modulus of walls, for hoop strains.",
       .source = "Table 2",
       .range = Range::positive()},
      {.key = "wall.poisson_ratio",
       .target = &p.poisson_ratio,
       .unit = "1",
       .meaning = "Poisson's ratio of walls.",
       .source = "Eq. (4)",
       .range = Range::between(0, 0.5)},
  };
}

}  // namespace

ParameterList declare(Parameters& p) {
  ParameterList all{
      {.key = "network.source",
       .target = &p.source,
       .meaning = "Where the vessels come from: \"tree\" makes the arterial tree and its venous mirror by "
                  "the rules of [tree], \"file\" reads network.files.",
       .source = "Sec. 3.3"},
      {.key = "network.files",
       .target = &p.files,
       .meaning =
           "The user's own network: one VTP, .vtk, SWC, JSON or GraphML file, one .dat file of Secomb's "
           "programs, or two CSV files, junctions and vessels. Looked for from the working folder, then "
           "from the input file's folder."},
      {.key = "network.file_length_unit",
       .target = &p.file_length_unit,
       .meaning =
           "Unit of coordinates, radii and lengths in a file that does not tell it, e.g. \"mm\"; VTP, .vtk "
           "and SWC files never do. What has a unit in the file keeps that.",
       .only_with = {when("network.source", Source::file)}},
      {.key = "network.merge_tolerance",
       .target = &p.merge_tolerance,
       .unit = "1",
       .meaning =
           "How near two places on centre lines must be, as a fraction of the smaller radius there, to "
           "be one: stretches that repeat other lines are left out, and ends of lines are joined across "
           "gaps.",
       .range = Range::between(0, 1),
       .only_with = {when("network.source", Source::file)}},
      {.key = "network.drop",
       .target = &p.drop,
       .meaning = "What is left out of a network from files: vessels from a junction to itself "
                  "(\"self_loops\"), parts "
                  "without any pressure or flow (\"islands\"), vessels that lead only to ends without one "
                  "(\"dead_ends\"). What is left out is told.",
       .choices = {"self_loops", "islands", "dead_ends"},
       .only_with = {when("network.source", Source::file)}},
      {.key = "network.reference_pressure",
       .target = &p.reference_pressure,
       .unit = "Pa",
       .default_in = "mmHg",
       .meaning =
           "Pressure at one end of each part of a network from files at whose ends only flows are known, "
           "which must sum to zero: at the end where most flows out. None: such a part is refused.",
       .only_with = {when("network.source", Source::file)}},
      {.key = "network.tier",
       .target = &p.tier,
       .meaning = "How the network is held: \"implicit\" (trees only: nothing is stored), \"explicit\" (all "
                  "vessels in memory), \"distributed\" (over all ranks' memory); auto: implicit for a tree, "
                  "explicit for files."},
      {.key = "network.statistics",
       .target = &p.statistics,
       .meaning = "Sweep over all vessels of a tree for statistics and histograms by generation."},
      {.key = "network.query",
       .target = &p.query,
       .meaning = "Vessels to report in full: ids, or in a tree paths such as \"artery.0110\" (the root's "
                  "first, second, second and first daughter) and \"vein.0110\"; in a file its names."},
      {.key = "network.shown_vessels",
       .target = &p.shown_vessels,
       .unit = "1",
       .meaning = "The most vessels to store and draw, the widest first; a picture can tell no more apart. "
                  "\"auto\": 20000 of a tree, all of a file's.",
       .range = Range::between(1, 5e6)},
      {.key = "network.vtp",
       .target = &p.vtp,
       .meaning =
           "Store the vessels as network.vtp too (VTK PolyData, metres; not with the distributed tier)."},
      {.key = "network.shown_subtree",
       .target = &p.shown_subtree,
       .meaning = "Place in the tree from which on vessels are stored and drawn, e.g. the path of a vessel a "
                  "few generations above the capillaries.",
       .only_with = {when("network.source", Source::tree)}},
  };
  for (const ParameterList& part :
       {declare(p.conditions), declare(p.tree), declare(p.wall), declare(p.wall_ranges), declare(p.weakness)})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

Tier Parameters::resolved_tier() const {
  if (tier != Tier::automatic) return tier;
  return is_tree() ? Tier::implicit_tree : Tier::explicit_graph;
}

}  // namespace rhexis::network
