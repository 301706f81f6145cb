// SPDX-License-Identifier: BSD-3-Clause
#include "network/tree/tree_rules.hpp"

#include <cmath>

#include "core/error.hpp"
#include "core/format.hpp"

namespace rhexis::network {
namespace {

/// `key`: of the most unequal daughters' gamma.
void check_narrowest(const TreeRules& rules, const char* key) {
  // The wider daughter's share is what is computed, and what the narrower one gets the rest of it.
  constexpr double least_share = 1e-8;
  const double share = rules.narrower_share(rules.least_asymmetry);
  if (share < least_share) {
    throw InputError("with xi " + text(rules.exponent) + " the narrower daughter would get " + text(share) +
                         " of r^xi, which is not above " + text(least_share),
                     key);
  }
  // Random splits hardly ever take the narrowest path: there, only what numbers can hold is asked for.
  const double least_radius = rules.random_splits() ? 1e-15 : 1e-9;
  const double narrowest = rules.root_radius * std::pow(share, (rules.generations - 1) / rules.exponent);
  if (narrowest < least_radius) {
    throw InputError("the narrowest vessels would have a radius of " + quantity(narrowest, "m") +
                         "; at least " + quantity(least_radius, "m") + " is allowed",
                     rules.least_asymmetry < 1 ? key : "tree.generations");
  }
}

}  // namespace

double TreeRules::wider_share(double gamma) const {
  return 1 / (1 + std::pow(gamma, exponent / 2));
}

double TreeRules::narrower_share(double gamma) const {
  return 1 / (1 + std::pow(gamma, -exponent / 2));
}

double TreeRules::length(int generation, double radius) const {
  if (!length_by_radius.empty()) return length_at(radius);
  const double ratio = length_ratio_by_generation.empty()
                           ? length_ratio
                           : length_ratio_by_generation[static_cast<std::size_t>(generation)];
  return ratio * radius;
}

double exponent_between(double root, double terminal, int generations) {
  return (generations - 1) * std::log(2.0) / std::log(root / terminal);
}

ParameterList declare(TreeParameters& p) {
  const char* recursion = "Sec. 3.3";
  return {
      {.key = "tree.generations",
       .target = &p.generations,
       .unit = "1",
       .meaning = "Generations k of each tree: 2 (2^k - 1) vessels in all, 34 billion for 34; to be given "
                  "for a tree.",
       .source = recursion,
       .range = Range::between(1, TreeRules::most_generations)},
      {.key = "tree.root_radius",
       .target = &p.root_radius,
       .unit = "m",
       .default_in = "mm",
       .meaning = "Lumen radius of the first artery.",
       .source = recursion,
       .range = Range::positive()},
      {.key = "tree.radius_exponent",
       .target = &p.exponent,
       .unit = "1",
       .meaning = "xi of r^xi = r1^xi + r2^xi; \"auto\": from terminal_radius, else 2.76.",
       .source = "Murray 1926; Olufsen 1999",
       .range = Range::between(1, 10)},
      {.key = "tree.terminal_radius",
       .target = &p.terminal_radius,
       .unit = "m",
       .meaning = "Lumen radius of the last vessels of a symmetric tree, from which xi follows.",
       .range = Range::positive()},
      {.key = "tree.asymmetry",
       .target = &p.asymmetry,
       .unit = "1",
       .meaning = "gamma = (r2/r1)^2 of two daughters; 1: both alike. Of the most symmetric ones where "
                  "splits are random.",
       .source = "Olufsen 1999",
       .range = Range::between(1e-4, 1)},
      {.key = "tree.least_asymmetry",
       .target = &p.least_asymmetry,
       .unit = "1",
       .meaning = "gamma of the most unequal daughters: every bifurcation draws its share evenly between the "
                  "two; \"auto\": no drawing.",
       .range = Range::between(1e-4, 1)},
      {.key = "tree.seed",
       .target = &p.seed,
       .unit = "1",
       .meaning = "Of the random numbers of splits and lengths.",
       .range = Range::not_negative()},
      {.key = "tree.length_ratio",
       .target = &p.length_ratio,
       .unit = "1",
       .meaning = "Length of a vessel in lumen radii, lambda.",
       .source = "Olufsen 1999",
       .range = Range::positive()},
      {.key = "tree.length_ratio_by_generation",
       .target = &p.length_ratio_by_generation,
       .unit = "1",
       .meaning = "lambda for each generation, the root's first, instead of one for all.",
       .range = Range::positive()},
      {.key = "tree.length_by_radius",
       .target = &p.length_by_radius,
       .unit = "m, m",
       .meaning = "Instead: a curve of [radius, length], straight between its points in logarithms.",
       .range = Range::positive()},
      {.key = "tree.length_spread",
       .target = &p.length_spread,
       .unit = "1",
       .meaning =
           "Each vessel's own length: evenly random within (1 - spread) to (1 + spread) times the rule's.",
       .range = Range::between(0, 0.9)},
      {.key = "tree.vein_radius_ratio",
       .target = &p.vein_radius_ratio,
       .unit = "1",
       .meaning = "Lumen radius of a vein over that of the artery that it mirrors.",
       .range = Range::between(0.1, 10)},
      {.key = "tree.layout",
       .target = &p.layout,
       .meaning = "Positions: bifurcations all in one plane, or in two planes by turns."},
  };
}

TreeRules rules_from(const TreeParameters& p, const Wall& artery_wall, const Wall& vein_wall) {
  if (!p.generations) throw InputError("is missing; give a number from 1 to 40", "tree.generations");
  TreeRules rules;
  rules.generations = static_cast<int>(*p.generations);
  rules.root_radius = p.root_radius;
  if (p.exponent && p.terminal_radius) {
    throw InputError("give either tree.radius_exponent or tree.terminal_radius, not both",
                     "tree.terminal_radius");
  }
  if (p.exponent) rules.exponent = *p.exponent;
  if (p.terminal_radius) {
    if (*p.terminal_radius >= p.root_radius) {
      throw InputError("must be below tree.root_radius, " + quantity(p.root_radius, "m"),
                       "tree.terminal_radius");
    }
    if (rules.generations < 2) throw InputError("needs two generations at least", "tree.terminal_radius");
    rules.exponent = exponent_between(p.root_radius, *p.terminal_radius, rules.generations);
    if (rules.exponent < 1 || rules.exponent > 10) {
      throw InputError("this makes xi " + text(rules.exponent) + ", which is not between 1 and 10",
                       "tree.terminal_radius");
    }
  }
  rules.asymmetry = p.asymmetry;
  rules.least_asymmetry = p.least_asymmetry.value_or(p.asymmetry);
  if (rules.least_asymmetry > rules.asymmetry) {
    throw InputError("must not be above tree.asymmetry, " + text(p.asymmetry), "tree.least_asymmetry");
  }
  rules.seed = static_cast<std::uint64_t>(p.seed);
  rules.length_ratio = p.length_ratio;
  const std::size_t given = p.length_ratio_by_generation.size();
  if (given != 0 && given != static_cast<std::size_t>(rules.generations)) {
    throw InputError("has " + std::to_string(given) + " values; tree.generations asks for " +
                         std::to_string(rules.generations),
                     "tree.length_ratio_by_generation");
  }
  if (given != 0 && !p.length_by_radius.empty()) {
    throw InputError("give either this or tree.length_ratio_by_generation, not both",
                     "tree.length_by_radius");
  }
  if (p.length_by_radius.size() == 1) throw InputError("needs two points at least", "tree.length_by_radius");
  for (std::size_t i = 1; i < p.length_by_radius.size(); ++i) {
    if (!(p.length_by_radius[i - 1].first < p.length_by_radius[i].first)) {
      throw InputError("radii must increase", "tree.length_by_radius");
    }
  }
  rules.length_ratio_by_generation = p.length_ratio_by_generation;
  rules.length_by_radius = p.length_by_radius;
  rules.length_spread = p.length_spread;
  rules.vein_radius_ratio = p.vein_radius_ratio;
  rules.artery_wall = artery_wall;
  rules.vein_wall = vein_wall;
  rules.layout = p.layout;
  check_narrowest(rules, p.least_asymmetry ? "tree.least_asymmetry" : "tree.asymmetry");
  return rules;
}

}  // namespace rhexis::network
