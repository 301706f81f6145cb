// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/statics/small_strain.hpp"

#include <cmath>

#include "core/error.hpp"
#include "core/format.hpp"

namespace rhexis::peridynamics {
namespace {

using Field = std::array<std::vector<double>, 3>;

class Stiffness {
 public:
  Stiffness(Body& body, double scale, parallel::Communicator comm)
      : body_(&body), scale_(scale), comm_(comm), volume_(body.volumes()), rest_(zero()) {}

  Field zero() const {
    Field field;
    for (std::vector<double>& component : field) component.assign(volume_.size(), 0.0);
    return field;
  }

  double dot(const Field& a, const Field& b) const {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < volume_.size(); ++i) sum += a[k][i] * b[k][i];
    }
    return comm_.all_reduce(sum, parallel::Reduce::sum);
  }

  /// Forces (N) at rest under a pressure, those on held components left out.
  Field load(double pressure) {
    body_->set_state(rest_, rest_);
    return forces(pressure);
  }

  /// -dF/du v, where the largest |v| is scaled to what is linear.
  Field times(const Field& v) {
    double largest = 0;
    for (const std::vector<double>& component : v) {
      for (const double x : component) largest = std::max(largest, std::abs(x));
    }
    largest = comm_.all_reduce(largest, parallel::Reduce::max);
    const double factor = largest > 0 ? scale_ / largest : 1;
    Field u = v;
    for (std::vector<double>& component : u) {
      for (double& x : component) x *= factor;
    }
    body_->set_state(u, rest_);
    u = forces(0);
    for (std::vector<double>& component : u) {
      for (double& x : component) x /= -factor;
    }
    return u;
  }

 private:
  Field forces(double pressure) {
    Field force = body_->force_density(pressure);
    body_->clear_held(force);
    for (std::vector<double>& component : force) {
      for (std::size_t i = 0; i < volume_.size(); ++i) component[i] *= volume_[i];
    }
    return force;
  }

  Body* body_;
  double scale_;
  parallel::Communicator comm_;
  std::vector<double> volume_;
  Field rest_;
};

void add(Field& to, double factor, const Field& what) {
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < to[k].size(); ++i) to[k][i] += factor * what[k][i];
  }
}

}  // namespace

SmallStrain find_small_strain(Body& body, double scale, double tolerance, parallel::Communicator comm) {
  Stiffness stiffness(body, scale, comm);
  constexpr int most = 20000;
  Field residual = stiffness.load(1), direction = residual;
  SmallStrain found{stiffness.zero(), 0};
  const double first = stiffness.dot(residual, residual);
  double rr = first;
  for (; rr > tolerance * tolerance * first; ++found.iterations) {
    if (found.iterations == most || !std::isfinite(rr))
      throw RunError("the forces of the body find no balance in " + std::to_string(found.iterations) +
                     " iterations; left of the load: " + text(std::sqrt(rr / first)));
    const Field product = stiffness.times(direction);
    const double step = rr / stiffness.dot(direction, product);
    add(found.displacement, step, direction);
    add(residual, -step, product);
    const double next = stiffness.dot(residual, residual);
    Field turned = residual;
    add(turned, next / rr, direction);
    direction = std::move(turned);
    rr = next;
  }
  return found;
}

}  // namespace rhexis::peridynamics
