// SPDX-License-Identifier: BSD-3-Clause
/// The displacement that bonds read: in the bonds' precision, in spacings, relative to a frame that follows
/// the body, so that single precision keeps its digits wherever the body goes.
#pragma once

#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "parallel/communicator.hpp"
#include "peridynamics/engine/domain.hpp"

namespace rhexis::peridynamics {

/// Period of wrapped displacements, in spacings: twice as long as the ends of any bond can be moved apart.
inline constexpr double wrap_period = 256;

/// From displacement along one axis (m) to spacings in the frame, wrapped to [-wrap_period / 2, wrap_period /
/// 2] where the frame is wrapped.
struct FrameAxis {
  double origin;           ///< m
  double inverse_spacing;  ///< 1/m
  double per_period;       ///< 1 / wrap_period, or 0 where displacements are not wrapped

  double operator()(double u) const {
    const double x = (u - origin) * inverse_spacing;
    return x - wrap_period * std::nearbyint(x * per_period);
  }
};

class FollowingFrame {
 public:
  explicit FollowingFrame(double spacing) : spacing_(spacing) {}

  const std::array<double, 3>& origin() const { return origin_; }  ///< m
  bool wrapped() const { return wrapped_; }
  FrameAxis axis(std::size_t k) const { return {origin_[k], 1 / spacing_, wrapped_ ? 1 / wrap_period : 0.0}; }

  /// Moves the origin to the middle of the displacements `u` (m, of owned particles) once it is more than
  /// `tolerance` spacings off, and begins to wrap once they are more than `wrap_distance` spacings apart from
  /// it, for then no frame serves all fragments. Minima and maxima are exact, so that every partition takes
  /// the same frame. Returns whether the frame is another one now. Collective.
  bool follow(const std::array<std::vector<double>, 3>& u, const parallel::Communicator& comm) {
    double extremes[6];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax_element(u[k].begin(), u[k].end());
      extremes[k] = -*low;
      extremes[3 + k] = *high;
    }
    comm.all_reduce(extremes, parallel::Reduce::max);
    bool moved = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const double middle = 0.5 * (extremes[3 + k] - extremes[k]);
      if (!wrapped_ && extremes[3 + k] - middle > wrap_distance * spacing_) wrapped_ = moved = true;
      if (std::abs(middle - origin_[k]) > tolerance * spacing_) {
        origin_[k] = middle;
        moved = true;
      }
    }
    return moved;
  }

  void restore(const std::array<double, 3>& origin, bool wrapped) {
    origin_ = origin;
    wrapped_ = wrapped;
  }

 private:
  static constexpr double tolerance = 4, wrap_distance = 512;

  double spacing_;  ///< m
  std::array<double, 3> origin_{};
  bool wrapped_ = false;
};

/// Two padded copies of the displacement in the frame: bonds read one while the next step's is written.
template <class Real>
class BondDisplacement {
 public:
  BondDisplacement(const Domain& domain, double spacing) : domain_(&domain), frame_(spacing) {
    for (Copy& copy : copies_) {
      for (auto& component : copy) {
        component = hwy::AllocateAligned<Real>(domain.padded_size());
        std::fill_n(component.get(), domain.padded_size(), Real{0});
      }
    }
  }

  /// Memory that this takes on all ranks.
  static double bytes(const BodySize& size) { return 2 * 3 * size.padded() * sizeof(Real); }

  const FollowingFrame& frame() const { return frame_; }
  std::array<Real*, 3> current() { return pointers(copies_[now_]); }
  std::array<const Real*, 3> current() const {
    return {copies_[now_][0].get(), copies_[now_][1].get(), copies_[now_][2].get()};
  }
  std::array<Real*, 3> next() { return pointers(copies_[1 - now_]); }
  void swap() { now_ = 1 - now_; }

  /// Lets the frame follow `u` and makes the copies anew where it moved. Collective.
  void follow(const std::array<std::vector<double>, 3>& u, const parallel::Communicator& comm) {
    if (frame_.follow(u, comm)) fill(u);
  }
  void restore_frame(const std::array<double, 3>& origin, bool wrapped) { frame_.restore(origin, wrapped); }

  /// Writes owned rows of both copies, because held rows are never written again.
  void fill(const std::array<std::vector<double>, 3>& u) {
    const ColumnLayout& layout = domain_->layout();
    for (Copy& copy : copies_) {
      for (std::size_t k = 0; k < 3; ++k) {
        const FrameAxis axis = frame_.axis(k);
        for (std::int32_t slot = 0; slot < layout.column_count; ++slot) {
          Real* const out = copy[k].get() + domain_->padded(RowBlock{slot, 0});
          const double* const in = u[k].data() + domain_->first_particle({slot, 0});
          for (std::int64_t r = 0; r < layout.row_count; ++r) out[r] = static_cast<Real>(axis(in[r]));
        }
      }
    }
  }

 private:
  using Copy = std::array<hwy::AlignedFreeUniquePtr<Real[]>, 3>;
  static std::array<Real*, 3> pointers(Copy& copy) { return {copy[0].get(), copy[1].get(), copy[2].get()}; }

  const Domain* domain_;
  FollowingFrame frame_;
  std::array<Copy, 2> copies_;
  std::size_t now_ = 0;
};

}  // namespace rhexis::peridynamics
