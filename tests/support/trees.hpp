// SPDX-License-Identifier: BSD-3-Clause
// Trees for tests, and their flow by plain recursion in long double.
#pragma once

#include <cmath>
#include <vector>

#include "hemodynamics/poiseuille.hpp"
#include "hemodynamics/viscosity.hpp"
#include "network/tree/random_stream.hpp"
#include "network/tree/tree_pair.hpp"

namespace rhexis::test {

inline network::TreeRules plain_rules(int generations) {
  network::TreeRules rules;
  rules.generations = generations;
  rules.root_radius = 12.5e-3;
  rules.exponent = 2.76;
  rules.length_ratio = 40;
  return rules;
}

/// Every vessel its own: random splits and lengths, other radii in veins.
inline network::TreeRules random_rules(int generations) {
  network::TreeRules rules = plain_rules(generations);
  rules.root_radius = 2e-3;
  rules.asymmetry = 0.95;
  rules.least_asymmetry = 0.3;
  rules.length_spread = 0.3;
  rules.vein_radius_ratio = 1.3;
  rules.seed = 0x123456789abcULL;
  return rules;
}

/// The upper generations of a body's tree of 34, every vessel its own.
inline network::TreeRules body_rules(int generations) {
  network::TreeRules rules = plain_rules(generations);
  rules.exponent =
      network::exponent_between(rules.root_radius, 3e-6 * std::exp2((34 - generations) / 2.76), generations);
  rules.least_asymmetry = 0.7;
  rules.length_spread = 0.2;
  rules.seed = 1;
  return rules;
}

inline hemodynamics::Viscosity in_vivo() {
  hemodynamics::Viscosity viscosity;
  viscosity.law = hemodynamics::ViscosityLaw::in_vivo;
  return viscosity;
}

/// Both trees by recursion from the rules, heap-indexed by place. Independent of tables, lanes and TreePair.
struct LongDoubleTree {
  using Real = long double;
  std::vector<Real> capacity, artery, vein, below, flow, artery_near, artery_far, vein_near, vein_far, radius,
      length;

  LongDoubleTree(const network::TreeRules& rules, const hemodynamics::Viscosity& viscosity, Real inlet,
                 Real outlet) {
    const std::size_t places = std::size_t{1} << rules.generations;
    for (auto* a : {&capacity, &artery, &vein, &below, &flow, &artery_near, &artery_far, &vein_near,
                    &vein_far, &radius, &length}) {
      a->resize(places);
    }
    capacity[1] = 1;
    const Real h = viscosity.haematocrit;
    for (std::size_t n = 1; n < places; ++n) {
      const int generation = network::TreePair::generation_of(n);
      radius[n] = rules.root_radius * std::pow(capacity[n], 1 / Real(rules.exponent));
      Real factor = 1;
      if (rules.random_lengths()) {
        const Real share = network::even_share(network::draw(rules.seed, network::Stream::lengths, n));
        factor = 1 + Real(rules.length_spread) * (2 * share - 1);
      }
      const Real base =
          !rules.length_by_radius.empty() ? rules.length_at(radius[n])
          : rules.length_ratio_by_generation.empty()
              ? Real(rules.length_ratio) * radius[n]
              : Real(rules.length_ratio_by_generation[static_cast<std::size_t>(generation)]) * radius[n];
      length[n] = base * factor;
      const Real vein_radius = radius[n] * Real(rules.vein_radius_ratio);
      artery[n] = hemodynamics::poiseuille_resistance(
          radius[n], length[n], hemodynamics::apparent_viscosity(viscosity, radius[n], h));
      vein[n] = hemodynamics::poiseuille_resistance(
          vein_radius, length[n], hemodynamics::apparent_viscosity(viscosity, vein_radius, h));
      if (2 * n >= places) continue;
      const Real most =
          1 / (1 + std::pow(Real(rules.least_asymmetry), Real(rules.exponent) / 2)) - Real(0.5L);
      const Real least = 1 / (1 + std::pow(Real(rules.asymmetry), Real(rules.exponent) / 2)) - Real(0.5L);
      Real first = Real(0.5L) + least;
      if (rules.random_splits()) {
        const std::uint32_t bits = network::draw(rules.seed, network::Stream::splits, n);
        const Real offset = least + (most - least) * Real(network::even_share(bits));
        first = network::coin(bits) ? Real(0.5L) - offset : Real(0.5L) + offset;
      }
      capacity[2 * n] = capacity[n] * first;
      capacity[2 * n + 1] = capacity[n] * (1 - first);
    }
    for (std::size_t n = places - 1; n > 0; --n) {
      below[n] = artery[n] + vein[n];
      if (2 * n < places) below[n] += 1 / (1 / below[2 * n] + 1 / below[2 * n + 1]);
    }
    flow[1] = (inlet - outlet) / below[1];
    artery_near[1] = inlet;
    vein_near[1] = outlet;
    for (std::size_t n = 1; n < places; ++n) {
      artery_far[n] = artery_near[n] - flow[n] * artery[n];
      vein_far[n] = vein_near[n] + flow[n] * vein[n];
      if (2 * n >= places) continue;
      for (std::size_t i = 0; i < 2; ++i) {
        artery_near[2 * n + i] = artery_far[n];
        vein_near[2 * n + i] = vein_far[n];
        flow[2 * n + i] = (artery_far[n] - vein_far[n]) / below[2 * n + i];
      }
    }
  }
};

}  // namespace rhexis::test
