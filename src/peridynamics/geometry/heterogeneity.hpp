// SPDX-License-Identifier: BSD-3-Clause
/// A wall whose properties differ from place to place: factors of mean 1 on critical stretch and stiffness
/// that scatter ([scatter]), times those of spots given by place ([[spot]]). All of it is a function of the
/// reference position, so that no rank needs to ask another.
///
/// A spot's factor f holds at its centre and is 1 + (f - 1) n elsewhere, with the nearness n of `Spots`. A
/// bond takes the arithmetic mean of its two ends' factors:
///
///   s0_ij = s0 (a_i + a_j) / 2,   c_ij = c (e_i + e_j) / 2
///
/// The random field knows no period: where ends are axial_periodic, factors jump where they meet.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "peridynamics/geometry/cross_section.hpp"
#include "peridynamics/geometry/gaussian_field.hpp"

namespace rhexis::peridynamics {

/// Factors on a particle's properties.
struct LocalFactors {
  double critical_stretch = 1, stiffness = 1;
};

class Heterogeneity {
 public:
  Heterogeneity() = default;  ///< a uniform wall
  /// The wall that resolved parameters describe.
  explicit Heterogeneity(const Parameters& p);

  bool uniform() const { return uniform_; }

  /// Factors at (x, y, z[i]), m.
  std::vector<LocalFactors> along(double x, double y, std::span<const double> z) const;

  /// The largest factors of any particle of the lattice; no bond has larger ones.
  LocalFactors largest(const Lattice& lattice) const;

 private:
  /// From a standard normal value to a factor.
  using Marginal = std::function<double(double)>;
  static Marginal marginal(ScatterLaw law, double spread);

  bool uniform_ = true;
  double mid_radius_ = 0;  ///< m
  Spots spots_;
  std::optional<GaussianField> field_;
  Marginal critical_stretch_, stiffness_;
};

}  // namespace rhexis::peridynamics
