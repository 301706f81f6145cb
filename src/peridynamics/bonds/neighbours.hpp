// SPDX-License-Identifier: BSD-3-Clause
/// Families of particles that lie anywhere: for each, which others are within the horizon.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "peridynamics/geometry/particle_set.hpp"

namespace rhexis::peridynamics {

/// Compressed rows: the family of particle i is partner[first[i]] .. partner[first[i + 1] - 1], ascending.
struct Neighbours {
  std::vector<std::size_t> first;
  std::vector<std::int32_t> partner;

  std::size_t size() const { return first.size() - 1; }
  std::span<const std::int32_t> of(std::size_t i) const {
    return {partner.data() + first[i], first[i + 1] - first[i]};
  }
  std::size_t family_size(std::size_t i) const { return first[i + 1] - first[i]; }
};

/// Whether no bond may cross between two places, because a cut lies between them.
class Separation {
 public:
  virtual ~Separation() = default;
  virtual bool between(const Vector3& a, const Vector3& b) const = 0;
};

/// All pairs nearer than `horizon` (m) and not separated; by cells as wide as the horizon. At most 2^31
/// particles. Throws InputError where two particles coincide or one has no neighbour at all.
Neighbours find_neighbours(const ParticleSet& set, double horizon, const Separation* cut = nullptr);

/// An order in which particles that are near in space are near in memory - along a Morton curve through
/// cells of `width` (m) - and, within runs of 256, ascending by their number of neighbours, so that 16 in
/// sequence have families of about one size.
std::vector<std::size_t> local_order(const ParticleSet& set, double horizon);

}  // namespace rhexis::peridynamics
