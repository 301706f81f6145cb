// SPDX-License-Identifier: BSD-3-Clause
/// What a body of any shape is made of: all that the general engine needs, resolved.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "peridynamics/bonds/gradient.hpp"
#include "peridynamics/bonds/neighbours.hpp"
#include "peridynamics/laws/correspondence/gradient_laws.hpp"

namespace rhexis::peridynamics {

/// Places of particles, in spacings from the first, are multiples of this: differences of places are exact in
/// single precision, and exactly opposite from the two ends of a bond.
inline constexpr double place_step = 0x1p-18;

/// Particles in the order in which the engine keeps them, their families and gradients. Every rank has them
/// all.
struct GeneralGeometry {
  ParticleSet particles;
  Neighbours neighbours;
  GradientWeights gradient;
  double horizon = 0;  ///< m
};

/// Orders the particles (local_order), moves them to the nearest multiples of `place_step`, finds their
/// families and the weights of their gradients. Throws InputError as find_neighbours does. `order`, where
/// given, takes the former numbers of the particles. `tolerance`: see find_gradient_weights; at 1e-3 the
/// expansion of a tube of five layers is the one at 1e-8 to a hundredth of its error, also where particles
/// are moved at random by 0.15 spacings.
std::shared_ptr<const GeneralGeometry> make_geometry(const ParticleSet& set, double horizon,
                                                     std::vector<std::size_t>* order = nullptr,
                                                     const Separation* cut = nullptr,
                                                     double tolerance = 1e-3);

/// Memory of such a geometry, on each rank, and of a body of it, on all, of `particles` particles with as
/// many `neighbours` on average; with what finding the gradients takes.
double geometry_bytes(double particles, double neighbours);
double general_body_bytes(double particles, double neighbours, bool double_bonds);

struct GeneralSetup {
  std::shared_ptr<const GeneralGeometry> geometry;
  GradientLaw law = NeoHookean(0, 0);
  double density = 0;  ///< kg/m3
  double critical_stretch = 0;
  double time_step = 0;     ///< s
  double energy_scale = 0;  ///< J, order of magnitude of the energies that will occur
  bool double_bonds = false;
  bool follower_load = true;  ///< the pressure acts on the deformed surface; else on the one at rest
  std::vector<std::uint8_t> held =
      {};  ///< [particles] bit k: the motion along axis k is held; empty: none is
};

}  // namespace rhexis::peridynamics
