#include "network/parameters.hpp"

namespace rhexis::network {
namespace {

Wall wall_of(const std::string& rule, double ratio) {
  return {rule == "radius" ? WallRule::radius : WallRule::ratio, ratio};
}

ParameterList declare(WallParameters& p) {
  const std::vector<std::string> rules{"ratio", "radius"};
  const char* rule =
      "Wall thickness over lumen radius: constant (\"ratio\"), or falling with the radius as in "
      "arteries (\"radius\": 0.12 in the aorta, 0.26 at 1.5 mm, 0.41 at 20 um). Of ";
  return {
      {"wall.artery_rule",
       &p.artery_rule,
       "",
       "\"ratio\"",
       std::string(rule) + "arteries.",
       "Boileau et al. 2015",
       {},
       rules},
      only_with({"wall.artery_rule", {"\"ratio\""}},
                {"wall.artery_ratio", &p.artery_ratio, "1", "0.3333333333333333",
                 "Wall thickness over lumen radius of arteries, for the rule \"ratio\".", "Table 2",
                 Range::positive()}),
      {"wall.vein_rule",
       &p.vein_rule,
       "",
       "\"ratio\"",
       std::string(rule) + "veins.",
       "Boileau et al. 2015",
       {},
       rules},
      only_with({"wall.vein_rule", {"\"ratio\""}},
                {"wall.vein_ratio", &p.vein_ratio, "1", "0.1", "The same of veins, for the rule \"ratio\".",
                 "Burton 1954 (vena cava: 1.5 mm at 30 mm)", Range::positive()}),
      {"wall.young_modulus", &p.young_modulus, "Pa", "\"3.5 MPa\"",
       "Young's modulus of walls, for hoop strains.", "Table 2", Range::positive()},
      {"wall.poisson_ratio", &p.poisson_ratio, "1", "0.25", "Poisson's ratio of walls.", "Eq. (4)",
       Range::between(0, 0.5)},
  };
}

}  // namespace

ParameterList declare(Parameters& p) {
  const std::vector<rhexis::Condition> a_graph{{"network.source", {"\"file\""}},
                                               {"network.tier", {"\"explicit\"", "\"distributed\""}}};
  ParameterList all{
      {"network.source",
       &p.source,
       "",
       "\"tree\"",
       "Where the vessels come from: \"tree\" makes the arterial tree and its venous mirror by the rules of "
       "[tree], "
       "\"file\" reads network.files.",
       "Sec. 3.3",
       {},
       {"tree", "file"}},
      {"network.files", &p.files, "", "[]",
       "The user's own network: one VTP or JSON file, or two CSV files, junctions and vessels. Looked for "
       "from the "
       "working folder, then from the input file's folder.",
       ""},
      only_with(
          {"network.source", {"\"file\""}},
          {"network.file_length_unit", &p.file_length_unit, "", "\"m\"",
           "Unit of coordinates, radii and lengths in a VTP file, which cannot tell, e.g. \"mm\".", ""}),
      {"network.tier",
       &p.tier,
       "",
       "\"auto\"",
       "How the network is held: \"implicit\" (trees only: nothing is stored), \"explicit\" (all vessels in "
       "memory), "
       "\"distributed\" (over all ranks' memory); auto: implicit for a tree, explicit for files.",
       "",
       {},
       {"auto", "implicit", "explicit", "distributed"}},
      only_with_one_of(a_graph,
                       {"network.solver",
                        &p.solver,
                        "",
                        "\"auto\"",
                        "For what is left of an explicit network when dead ends, series and parallels are "
                        "eliminated: nothing "
                        "may be "
                        "left (elimination), direct (ldlt), or conjugate gradients with a preconditioner.",
                        "",
                        {},
                        {"auto", "elimination", "ldlt", "approximate_cholesky", "jacobi", "amg"}}),
      only_with_one_of(a_graph,
                       {"network.imbalance", &p.imbalance, "1", "1e-10",
                        "Stop when blood is conserved at the worst junction to this share of the inflow.", "",
                        Range::between(1e-15, 1e-3)}),
      only_with_one_of(a_graph, {"network.max_iterations", &p.max_iterations, "1", "20000",
                                 "Of an iterative solver.", "", Range::at_least(1)}),
      {"network.statistics", &p.statistics, "", "true",
       "Sweep over all vessels of a tree for statistics and histograms by generation.", ""},
      {"network.query", &p.query, "", "[]",
       "Vessels to report in full: ids, or in a tree paths such as \"artery.0110\" (the root's first, "
       "second, second "
       "and first daughter) and \"vein.0110\"; in a file its names.",
       ""},
      {"network.shown_vessels", &p.shown_vessels, "1", "\"auto\"",
       "The most vessels to store and draw, the widest first; a picture can tell no more apart. \"auto\": "
       "20000 of a "
       "tree, all of a file's.",
       "", Range::between(1, 5e6)},
      {"network.vtp", &p.vtp, "", "false",
       "Store the vessels as network.vtp too (VTK PolyData, metres; not with the distributed tier).", ""},
      only_with(
          {"network.source", {"\"tree\""}},
          {"network.shown_subtree", &p.shown_subtree, "", "\"artery.\"",
           "Place in the tree from which on vessels are stored and drawn, e.g. the path of a vessel a few "
           "generations "
           "above the capillaries.",
           ""}),
  };
  for (const ParameterList& part : {declare(p.tree), declare(p.wall), declare(p.weakness)})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

Wall artery_wall(const WallParameters& p) {
  return wall_of(p.artery_rule, p.artery_ratio);
}
Wall vein_wall(const WallParameters& p) {
  return wall_of(p.vein_rule, p.vein_ratio);
}

}  // namespace rhexis::network
