// SPDX-License-Identifier: BSD-3-Clause
/// Families of a rank's particles as the general engine's kernel wants them: blocks of 16 particles, the k-th
/// bonds of all 16 side by side ("slot" k).
/// Lengths are in spacings.
#pragma once

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "peridynamics/engine/block_partition.hpp"
#include "peridynamics/engine/general_setup.hpp"
#include "peridynamics/engine/quads.hpp"

namespace rhexis::peridynamics {

/// The share of a family's smallest moment from which on a particle that has lost bonds carries less and less
/// stress, and that at which it carries none: its gradient would hang on too few bonds, and the stiffness of
/// those that are left grows with their load.
inline constexpr double weakening_moment = 0.25, least_moment = 0.05;

/// The difference of two particles' quads, in double precision.
template <class T>
Eigen::Vector3d difference(const std::vector<T>& quads, std::size_t from, std::size_t to) {
  const auto component = [&](std::size_t k) {
    return static_cast<double>(quads[quad * to + k]) - static_cast<double>(quads[quad * from + k]);
  };
  return {component(0), component(1), component(2)};
}

template <class Real>
class FamilyBlocks {
 public:
  FamilyBlocks(const GeneralGeometry& geometry, const BlockPartition& partition)
      : partition_(&partition), spacing_(geometry.particles.spacing) {
    place_particles(geometry);
    fill_families(geometry);
    find_reverse(geometry);
    const std::size_t evaluated = width * partition.evaluated_blocks();
    for (auto& component : slope) component.assign(evaluated, Real(0));
    for (auto& component : shape) component.assign(evaluated, Real(0));
    strength.assign(evaluated, Real(0));
    damage.assign(evaluated, 0.0);
    for (std::size_t b = 0; b < partition.evaluated_blocks(); ++b) update(b, 0xffff);
  }

  static constexpr std::size_t width = static_cast<std::size_t>(block_rows);

  std::size_t first_slot(std::size_t block) const { return first_slot_[block]; }
  std::size_t slots(std::size_t block) const { return first_slot_[block + 1] - first_slot_[block]; }
  std::size_t slots() const { return first_slot_.back(); }
  std::size_t most_slots() const { return most_slots_; }

  // Known particles have:
  std::vector<std::int32_t> place;  ///< in steps, quads (engine/quads.hpp)
  std::vector<Real> multiplier;     ///< GradientWeights, quads
  std::vector<Real> volume;         ///< in spacings^3

  // Bonds have, [slots][16]:
  std::vector<std::int32_t> partner;  ///< where the other end's quad begins; its own where it has no bond
  std::vector<std::int32_t> reverse;  ///< where the other end's T stands among forces, [slots][16][3]
  std::vector<Real> weight;           ///< w_ij V_j
  std::vector<std::uint16_t> words;   ///< [slots] bit k: the bond of particle k exists and is unbroken

  // Evaluated particles have, from the bonds that are left:
  std::array<std::vector<Real>, 9> slope;  ///< B_i of the gradient, row by row
  std::array<std::vector<Real>, 6> shape;  ///< sum_j w V_j xi (x) xi / |xi|^2: xx, yy, zz, xy, xz, yz
  std::vector<Real> strength;              ///< the share of the stress that a particle carries, 1 to 0
  std::vector<Real> inverse_weight;        ///< 1 / sum_j w V_j of the whole family
  std::vector<double> damage;              ///< Eq. (6)

  /// Finds anew what follows from the bonds of the particles of a block whose bits are set in `lanes`.
  void update(std::size_t block, unsigned lanes) {
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
      if (static_cast<int>(lane) < partition_->particles_in(partition_->block(block)))
        update_particle(block, lane);
    }
  }

  /// The inverse of the moment of the bonds that a particle has left; 0 where it carries no stress.
  Eigen::Matrix3d inverse_moment(std::size_t particle) const {
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    if (strength[particle] == 0) return moment;
    const std::size_t block = particle / width, lane = particle % width;
    for (std::size_t slot = first_slot_[block]; slot < first_slot_[block + 1]; ++slot) {
      if ((words[slot] >> lane & 1U) == 0) continue;
      const Eigen::Vector3d xi = bond(particle, other_end(slot * width + lane));
      moment += double{weight[slot * width + lane]} * xi * xi.transpose();
    }
    return moment.inverse();
  }

  /// xi of a bond, in spacings.
  Eigen::Vector3d bond(std::size_t particle, std::size_t other) const {
    return place_step * difference(place, particle, other);
  }

  /// Local number of the particle at the other end of a bond.
  std::size_t other_end(std::size_t bond) const { return static_cast<std::size_t>(partner[bond]) / quad; }

  /// Difference of multipliers over a bond.
  Eigen::Vector3d multiplier_step(std::size_t particle, std::size_t other) const {
    return difference(multiplier, particle, other);
  }

 private:
  void place_particles(const GeneralGeometry& geometry) {
    const ParticleSet& set = geometry.particles;
    const std::size_t known = width * partition_->known_blocks();
    place.assign(quad * known, 0);
    multiplier.assign(quad * known, Real(0));
    volume.assign(known, Real(0));
    for (std::size_t b = 0; b < partition_->known_blocks(); ++b) {
      for (int lane = 0; lane < partition_->particles_in(partition_->block(b)); ++lane) {
        const std::size_t here = b * width + static_cast<std::size_t>(lane);
        const auto particle = static_cast<std::size_t>(partition_->block(b) * block_rows + lane);
        for (std::size_t k = 0; k < 3; ++k) {
          place[quad * here + k] = static_cast<std::int32_t>(
              std::lround((set.position[k][particle] - set.position[k][0]) / (spacing_ * place_step)));
          multiplier[quad * here + k] = static_cast<Real>(geometry.gradient.multiplier[particle][k]);
        }
        volume[here] = static_cast<Real>(set.volume[particle] / std::pow(spacing_, 3));
      }
    }
  }

  void fill_families(const GeneralGeometry& geometry) {
    first_slot_.push_back(0);
    inverse_weight.assign(width * partition_->evaluated_blocks(), Real(0));
    for (std::size_t b = 0; b < partition_->evaluated_blocks(); ++b) {
      const std::int64_t first = partition_->block(b) * block_rows;
      const int count = partition_->particles_in(partition_->block(b));
      std::size_t longest = 0;
      for (int lane = 0; lane < count; ++lane)
        longest = std::max(longest, geometry.neighbours.family_size(static_cast<std::size_t>(first + lane)));
      most_slots_ = std::max(most_slots_, longest);
      for (std::size_t slot = 0; slot < longest; ++slot) {
        std::uint16_t word = 0;
        for (int lane = 0; lane < block_rows; ++lane) {
          const auto particle = static_cast<std::size_t>(first + lane);
          const bool exists = lane < count && slot < geometry.neighbours.family_size(particle);
          const std::size_t bond = exists ? geometry.neighbours.first[particle] + slot : 0;
          const std::int32_t other = exists ? partition_->local(geometry.neighbours.partner[bond])
                                            : static_cast<std::int32_t>(b * width) + lane;
          partner.push_back(static_cast<std::int32_t>(quad) * other);
          weight.push_back(exists ? static_cast<Real>(geometry.gradient.weight[bond]) : Real(0));
          if (exists) word = static_cast<std::uint16_t>(word | 1U << lane);
        }
        words.push_back(word);
      }
      first_slot_.push_back(first_slot_.back() + longest);
      for (int lane = 0; lane < count; ++lane) {
        const auto particle = static_cast<std::size_t>(first + lane);
        double sum = 0;
        for (std::size_t k = geometry.neighbours.first[particle]; k < geometry.neighbours.first[particle + 1];
             ++k)
          sum += geometry.gradient.weight[k];
        inverse_weight[b * width + static_cast<std::size_t>(lane)] = static_cast<Real>(1 / sum);
      }
    }
  }

  void find_reverse(const GeneralGeometry& geometry) {
    reverse.assign(first_slot_[partition_->owned_blocks()] * width, 0);
    for (std::size_t b = 0; b < partition_->owned_blocks(); ++b) {
      for (std::size_t slot = first_slot_[b]; slot < first_slot_[b + 1]; ++slot) {
        for (std::size_t lane = 0; lane < width; ++lane) {
          const std::size_t bond = slot * width + lane;
          const auto other = other_end(bond);
          std::size_t there = slot;  // of a bond that does not exist: itself
          if ((words[slot] >> lane & 1U) != 0) {
            const auto id = static_cast<std::int32_t>(partition_->block(b) * block_rows) +
                            static_cast<std::int32_t>(lane);
            const auto family = geometry.neighbours.of(
                static_cast<std::size_t>(partition_->block(other / width)) * width + other % width);
            const auto position = std::lower_bound(family.begin(), family.end(), id) - family.begin();
            there = first_slot_[other / width] + static_cast<std::size_t>(position);
          }
          reverse[bond] = static_cast<std::int32_t>(3 * (width * there + other % width));
        }
      }
    }
  }

  void update_particle(std::size_t block, std::size_t lane) {
    using Matrix = Eigen::Matrix3d;
    const std::size_t i = block * width + lane;
    Matrix whole = Matrix::Zero(), moment = Matrix::Zero(), turned = Matrix::Zero(),
           directions = Matrix::Zero();
    double all = 0, left = 0;
    for (std::size_t slot = first_slot_[block]; slot < first_slot_[block + 1]; ++slot) {
      const std::size_t b = slot * width + lane;
      const auto j = other_end(b);
      if (weight[b] == 0) continue;
      const Eigen::Vector3d xi = bond(i, j);
      const double w = weight[b];
      const Matrix outer = w * xi * xi.transpose();
      whole += outer;
      all += volume[j];
      if ((words[slot] >> lane & 1U) == 0) continue;
      left += volume[j];
      moment += outer;
      directions += outer / xi.squaredNorm();
      turned += w * multiplier_step(i, j) * xi.transpose();
    }
    damage[i] = all > 0 ? 1 - left / all : 0;
    const double share = smallest_eigenvalue(moment) / smallest_eigenvalue(whole);
    const double left_over = std::min(1.0, (share - least_moment) / (weakening_moment - least_moment));
    strength[i] = static_cast<Real>(left_over > 0 ? left_over : 0.0);
    const Matrix b = strength[i] > 0
                         ? Matrix((Matrix::Identity() - double{volume[i]} * turned) * moment.inverse())
                         : Matrix(Matrix::Zero());
    for (std::size_t k = 0; k < 9; ++k)
      slope[k][i] = static_cast<Real>(b(static_cast<int>(k / 3), static_cast<int>(k % 3)));
    constexpr int rows[] = {0, 1, 2, 0, 0, 1}, columns[] = {0, 1, 2, 1, 2, 2};
    for (std::size_t k = 0; k < 6; ++k) shape[k][i] = static_cast<Real>(directions(rows[k], columns[k]));
  }

  static double smallest_eigenvalue(const Eigen::Matrix3d& a) {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(a, Eigen::EigenvaluesOnly).eigenvalues()[0];
  }

  const BlockPartition* partition_;
  double spacing_;
  std::vector<std::size_t> first_slot_;
  std::size_t most_slots_ = 0;
};

}  // namespace rhexis::peridynamics
