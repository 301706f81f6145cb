// SPDX-License-Identifier: BSD-3-Clause
/// Particles of a body of any shape, with the surface that bounds it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "peridynamics/geometry/cross_section.hpp"
#include "peridynamics/geometry/wall_frame.hpp"

namespace rhexis::peridynamics {

using Vector3 = std::array<double, 3>;

/// A piece of a body's surface, and the particle that it moves with.
struct SurfacePatch {
  std::size_t particle;
  Vector3 offset;  ///< m, from the particle to the patch
  Vector3 area;    ///< m2, along the normal that points out of the body
  bool loaded;     ///< whether the pressure acts here
};

/// A body at rest. Its patches close the surface: their areas sum to 0, and the sum of area (x) place is the
/// body's volume times the unit tensor, as Gauss's theorem has it.
struct ParticleSet {
  double spacing = 0;                                ///< m, the usual distance of neighbours
  std::array<std::vector<double>, 3> position = {};  ///< m
  std::vector<double> volume = {};                   ///< m3
  std::vector<SurfacePatch> surface = {};
  std::vector<WallFrame> frame = {};  ///< [particles]; empty: the body is no wall

  std::size_t size() const { return volume.size(); }
  Vector3 at(std::size_t i) const { return {position[0][i], position[1][i], position[2][i]}; }
};

/// The rings of a straight tube along z, in the lattice's order: id = column * rows + row. The pressure acts
/// on the lumen. The cross-section must be polar.
ParticleSet tube_particles(const Lattice& lattice);

/// A box with one corner at the origin, of `count` cubes of edge `spacing` (m) along each axis, the last axis
/// quickest. The pressure acts nowhere.
ParticleSet box_particles(const std::array<std::size_t, 3>& count, double spacing);

/// A thick sphere about the origin: `layers` spherical layers between two radii (m), each of them a Fibonacci
/// lattice whose points are one layer's thickness apart at mid-wall. The pressure acts inside.
ParticleSet sphere_particles(double inner_radius, double outer_radius, std::size_t layers);

/// Corrects the areas of pieces that make one closed surface, each in proportion to its size, so that they
/// sum to 0 and the sum of area (x) place is `volume` (m3) times the unit tensor; negative where normals
/// point inwards.
void close_surface(const ParticleSet& set, std::span<SurfacePatch> surface, double volume);

/// The same particles, the k-th of which is the former `order[k]`.
ParticleSet reordered(const ParticleSet& set, const std::vector<std::size_t>& order);

}  // namespace rhexis::peridynamics
