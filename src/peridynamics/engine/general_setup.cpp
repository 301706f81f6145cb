// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/engine/general_setup.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/error.hpp"

namespace rhexis::peridynamics {
namespace {

/// Moves particles to the nearest multiples of `place_step` spacings from the first one; the surface stays.
void snap(ParticleSet& set) {
  const double step = place_step * set.spacing;
  const Vector3 origin = set.at(0);
  std::vector<Vector3> moved(set.size());
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < set.size(); ++i) {
      const double place = origin[k] + step * std::round((set.position[k][i] - origin[k]) / step);
      moved[i][k] = place - set.position[k][i];
      set.position[k][i] = place;
    }
  }
  for (SurfacePatch& patch : set.surface) {
    for (std::size_t k = 0; k < 3; ++k) patch.offset[k] -= moved[patch.particle][k];
  }
}

}  // namespace

std::shared_ptr<const GeneralGeometry> make_geometry(const ParticleSet& set, double horizon,
                                                     std::vector<std::size_t>* order, const Separation* cut,
                                                     double tolerance) {
  std::vector<std::size_t> sorted = local_order(set, horizon);
  ParticleSet particles = reordered(set, sorted);
  snap(particles);
  if (order != nullptr) *order = std::move(sorted);
  Neighbours neighbours = find_neighbours(particles, horizon, cut);
  GradientWeights gradient = find_gradient_weights(particles, neighbours, horizon, tolerance);
  if (!(gradient.imbalance < 0.05))
    throw InputError(
        fmt::format("a homogeneous stress would push particles inside the body, with {:.2g} of the "
                    "force on the surface of a spacing: its surface is not closed, or particles "
                    "lie too unevenly",
                    gradient.imbalance));
  return std::make_shared<const GeneralGeometry>(
      GeneralGeometry{std::move(particles), std::move(neighbours), std::move(gradient), horizon});
}

double geometry_bytes(double particles, double neighbours) {
  const double bond = sizeof(std::int32_t) + sizeof(double);
  const double particle = sizeof(std::size_t) + 7 * sizeof(double);  // families, place, volume, multiplier
  const double solving = (3 + 1 + 9 + 9 + 4 * 3) * sizeof(double);
  return particles * (particle + solving + 1.3 * neighbours * bond);  // vectors grow by more than they need
}

double general_body_bytes(double particles, double neighbours, bool double_bonds) {
  const double real = double_bonds ? sizeof(double) : sizeof(float);
  const double padding = 1.2;  // of blocks with families of several sizes, and vectors that grew
  const double bond = 2 * sizeof(std::int32_t) + 4 * real;
  const double particle =
      3 * sizeof(std::int32_t) + (3 + 1 + 9 + 6 + 1 + 1 + 3 + 9) * real + 11 * sizeof(double);
  return particles * (particle + padding * neighbours * bond);
}

}  // namespace rhexis::peridynamics
