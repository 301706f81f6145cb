// SPDX-License-Identifier: BSD-3-Clause
/// Input keys of the sections network, tree, wall and weakness.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/parameter.hpp"
#include "network/tree_rules.hpp"
#include "network/wall.hpp"
#include "network/wall_variation.hpp"

namespace rhexis::network {

struct WallParameters {
  std::string artery_rule = "ratio", vein_rule = "ratio";
  double artery_ratio = 1.0 / 3, vein_ratio = 0.1;
  double young_modulus = 3.5e6;  ///< Pa
  double poisson_ratio = 0.25;
};

struct Parameters {
  std::string source = "tree";  ///< "tree" | "file"
  std::vector<std::string> files;
  std::string file_length_unit = "m";
  std::string tier = "auto";  ///< "auto" | "implicit" | "explicit" | "distributed"
  std::string solver = "auto";
  double imbalance = 1e-10;
  std::int64_t max_iterations = 20000;
  bool statistics = true;
  std::vector<std::string> query;
  std::optional<std::int64_t> shown_vessels;
  std::string shown_subtree = "artery.";
  bool vtp = false;
  TreeParameters tree;
  WallParameters wall;
  WeaknessParameters weakness;
};

/// The keys, bound to `p`.
ParameterList declare(Parameters& p);

Wall artery_wall(const WallParameters& p);
Wall vein_wall(const WallParameters& p);

}  // namespace rhexis::network
