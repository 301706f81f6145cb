// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/stability/linear_limit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "peridynamics/engine/general_body.hpp"
#include "peridynamics/tube_setup.hpp"

namespace rhexis::peridynamics {
namespace {

using Field = std::array<std::vector<double>, 3>;

/// The operator A = -M^-1 K of accelerations, self-adjoint where particles are weighted by their volumes.
class Accelerations {
 public:
  /// A body of particles `spacing` (m) apart.
  Accelerations(std::unique_ptr<Body> body, double spacing, double density)
      : body_(std::move(body)), size_(1e-5 * spacing), density_(density), volume_(body_->volumes()) {
    for (double& volume : volume_) volume /= std::pow(spacing, 3);
    for (std::vector<double>& component : rest_) component.assign(volume_.size(), 0.0);
  }

  std::size_t size() const { return volume_.size(); }

  double dot(const Field& a, const Field& b) const {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < size(); ++i) sum += volume_[i] * a[k][i] * b[k][i];
    }
    return sum;
  }

  /// -A v, s-2, for v of norm 1: as a displacement of 1e-5 spacings in all, for which the law is linear.
  Field of(const Field& v) {
    Field u = v;
    for (std::vector<double>& component : u) {
      for (double& x : component) x *= size_;
    }
    body_->set_state(u, rest_);
    u = body_->force_density(0);
    for (std::vector<double>& component : u) {
      for (double& x : component) x /= -density_ * size_;
    }
    return u;
  }

 private:
  std::unique_ptr<Body> body_;
  double size_;  ///< m
  double density_;
  std::vector<double> volume_;  ///< in spacings^3
  Field rest_;
};

/// Eigenvalues of a symmetric tridiagonal matrix that are above `x`: positive pivots of T - x (Sylvester).
int count_above(const std::vector<double>& diagonal, const std::vector<double>& beside, double x) {
  int above = 0;
  double pivot = 1;
  for (std::size_t i = 0; i < diagonal.size(); ++i) {
    const double from_left = i == 0 ? 0 : beside[i - 1] * beside[i - 1] / pivot;
    pivot = diagonal[i] - x - from_left;
    if (pivot > 0) ++above;
    if (pivot == 0) pivot = 1e-300;
  }
  return above;
}

double largest_eigenvalue(const std::vector<double>& diagonal, const std::vector<double>& beside) {
  double low = *std::max_element(diagonal.begin(), diagonal.end()), high = 2 * low;
  while (count_above(diagonal, beside, high) > 0) high *= 2;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (count_above(diagonal, beside, middle) > 0 ? low : high) = middle;
  }
  return high;
}

/// A periodic piece of the uniform wall, of as few rows as hold a family and the shortest axial waves.
BodySetup periodic_piece(BodySetup setup) {
  setup.lattice.rows = 2 * setup.families->reach + 2;
  setup.ends = EndCondition::axial_periodic;
  setup.double_bonds = true;
  setup.heterogeneity = {};
  setup.thin_spots = {};
  return setup;
}

/// s, by Lanczos' method.
double time_step_limit(Accelerations accelerations) {
  constexpr int iterations = 60;
  const std::size_t n = accelerations.size();
  Field now, before;
  for (std::size_t k = 0; k < 3; ++k) {
    now[k].resize(n);
    before[k].assign(n, 0.0);
    // No mode is orthogonal to so irregular a start.
    for (std::size_t i = 0; i < n; ++i) now[k][i] = std::sin(static_cast<double>((3 * i + k + 1) * (i + 7)));
  }
  const auto scale = [](Field& field, double factor) {
    for (std::vector<double>& component : field) {
      for (double& x : component) x *= factor;
    }
  };
  scale(now, 1 / std::sqrt(accelerations.dot(now, now)));
  std::vector<double> diagonal, beside;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    Field next = accelerations.of(now);
    diagonal.push_back(accelerations.dot(now, next));
    const double from_before = beside.empty() ? 0 : beside.back();
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < n; ++i)
        next[k][i] -= diagonal.back() * now[k][i] + from_before * before[k][i];
    }
    beside.push_back(std::sqrt(accelerations.dot(next, next)));
    scale(next, 1 / beside.back());
    before = std::exchange(now, std::move(next));
  }
  return 2 / std::sqrt(largest_eigenvalue(diagonal, beside));
}

}  // namespace

double linear_time_step_limit(const BodySetup& setup) {
  return time_step_limit({make_body(periodic_piece(setup), parallel::Communicator::self()),
                          setup.lattice.spacing, setup.density});
}

double linear_time_step_limit(const Parameters& p, const BodySetup& tube) {
  return time_step_limit({make_body(make_short_tube(p, tube).setup, parallel::Communicator::self()),
                          tube.lattice.spacing, tube.density});
}

double allowance_for_stretch(const Parameters& p) {
  const double stiffening =
      std::visit([&](const auto& law) { return law.stiffening(*p.critical_stretch); }, gradient_law(p));
  return (1 + *p.critical_stretch) * std::sqrt(stiffening);
}

double linear_time_step_limit(const WallModel& wall) {
  return wall.by_gradient() ? wall.time.stable * allowance_for_stretch(wall.parameters)
                            : linear_time_step_limit(wall.setup);
}

double linear_limit_bytes(const Parameters& p, const WallSize& size) {
  const double rows = rows_within(*p.horizon * size.rows / p.length) + 1;
  BodySize piece = body_size(p, size, rows, 1);
  piece.heterogeneous = piece.thinned = false;
  constexpr double vectors = 19;  // of a number for each particle
  return body_bytes(p.law, /*double_bonds=*/true, piece) + Observation::bytes(piece.particles()) +
         vectors * piece.particles() * sizeof(double);
}

}  // namespace rhexis::peridynamics
