// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/tree/tree_law.hpp"

#include <cmath>

#include "hemodynamics/poiseuille.hpp"

namespace rhexis::hemodynamics {

TreeLaw::TreeLaw(const network::TreePair& tree, const Viscosity& viscosity) : radius(tree.radius_table()) {
  const network::TreeRules& rules = tree.rules();
  seed = rules.seed;
  random_splits = rules.random_splits();
  random_lengths = rules.random_lengths();
  least_offset = rules.wider_share(rules.asymmetry) - 0.5;
  offset_range = random_splits ? rules.wider_share(rules.least_asymmetry) - 0.5 - least_offset : 0;
  length_spread = rules.length_spread;

  const long double root = rules.root_radius, power = 1 / static_cast<long double>(rules.exponent);
  const auto radius_of = [=](long double capacity) { return root * std::pow(capacity, power); };
  const auto capacity_of = [&](double r) {
    return static_cast<double>(std::pow(r / root, static_cast<long double>(rules.exponent)));
  };
  length_is_radius = rules.length_by_radius.empty();
  const auto length_of = [=](long double r) -> long double {
    return rules.length_by_radius.empty() ? r : rules.length_at(r);
  };

  const double least = tree.least_capacity();
  std::vector<double> length_kinks, artery_kinks, vein_kinks;
  for (const auto& [r, l] : rules.length_by_radius) length_kinks.push_back(capacity_of(r));
  artery_kinks = vein_kinks = length_kinks;
  if (viscosity.law != ViscosityLaw::constant) {
    artery_kinks.push_back(capacity_of(viscosity.least_radius()));
    vein_kinks.push_back(capacity_of(viscosity.least_radius() / rules.vein_radius_ratio));
  }
  const auto resistance = [=](long double r, long double ratio) {
    return poiseuille_resistance(
        r * ratio, length_of(r),
        apparent_viscosity(viscosity, r * ratio, static_cast<long double>(viscosity.haematocrit)));
  };
  artery_resistance = network::IntervalTable([=](long double a) { return resistance(radius_of(a), 1); },
                                             least, 1, artery_kinks);
  const long double ratio = rules.vein_radius_ratio;
  vein_follows = ratio == 1 || viscosity.law == ViscosityLaw::constant;
  if (vein_follows) {
    vein_factor = static_cast<double>(1 / (ratio * ratio * ratio * ratio));
  } else {
    vein_resistance = network::IntervalTable([=](long double a) { return resistance(radius_of(a), ratio); },
                                             least, 1, vein_kinks);
  }
  if (!length_is_radius) {
    length = network::IntervalTable([=](long double a) { return length_of(radius_of(a)); }, least, 1,
                                    length_kinks);
  }
  generation_factor.assign(static_cast<std::size_t>(rules.generations),
                           length_is_radius ? rules.length_ratio : 1.0);
  if (!rules.length_ratio_by_generation.empty()) generation_factor = rules.length_ratio_by_generation;
}

}  // namespace rhexis::hemodynamics
