// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/bonds/gradient.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "parallel/communicator.hpp"
#include "parallel/threads.hpp"

namespace rhexis::peridynamics {
namespace {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;
/// One 3-vector for each particle; column c belongs to component c of the multipliers.
using Field = std::vector<Vector>;

class Consistency {
 public:
  Consistency(const ParticleSet& set, const Neighbours& neighbours, GradientWeights& weights, double horizon)
      : neighbours_(&neighbours), weights_(&weights), threads_(parallel::thread_count()) {
    const double h = set.spacing;
    for (std::size_t i = 0; i < set.size(); ++i) {
      place_.push_back(Vector(set.position[0][i], set.position[1][i], set.position[2][i]) / h);
      volume_.push_back(set.volume[i] / (h * h * h));
    }
    weights.weight.resize(neighbours.partner.size());
    inverse_moment_.resize(set.size());
    slope_.resize(set.size());
    each_particle([&](std::size_t i) {
      Matrix moment = Matrix::Zero();
      for (std::size_t b = neighbours.first[i]; b < neighbours.first[i + 1]; ++b) {
        const Vector xi = bond(i, b);
        weights.weight[b] = influence(xi.norm() * h / horizon) * volume_[partner(b)];
        moment += weights.weight[b] * xi * xi.transpose();
      }
      inverse_moment_[i] = moment.inverse();
    });
    for (const SurfacePatch& p : set.surface) {
      patches_.push_back({p.particle, Vector(p.offset[0], p.offset[1], p.offset[2]) / h,
                          Vector(p.area[0], p.area[1], p.area[2]) / (h * h)});
    }
  }

  std::size_t size() const { return place_.size(); }

  /// b_k less sum_i V_i dH_i/du_k, with the gradient that multipliers `m` make. The surface moves with what
  /// the gradient by moments extrapolates to it.
  Field imbalance(const Field& m) const {
    std::vector<Matrix> slope(size());  // B_i
    each_particle([&](std::size_t i) {
      Matrix sum = Matrix::Zero();
      for (std::size_t b = neighbours_->first[i]; b < neighbours_->first[i + 1]; ++b)
        sum += weights_->weight[b] * (m[partner(b)] - m[i]) * bond(i, b).transpose();
      slope[i] = (Matrix::Identity() - volume_[i] * sum) * inverse_moment_[i];
    });
    Field result(size(), Vector::Zero());
    each_particle([&](std::size_t k) {
      // G_jk of the bonds from others to this one, and G_kj of this one's own.
      for (std::size_t b = neighbours_->first[k]; b < neighbours_->first[k + 1]; ++b) {
        const std::size_t j = partner(b);
        const Vector xi = bond(k, b), step = m[j] - m[k];
        const double w = weights_->weight[b] * volume_[k];  // w V_j V_k
        result[k] += w * (slope[j] * xi + volume_[j] * step) + w * (slope[k] * xi + volume_[k] * step);
      }
    });
    for (const Patch& p : patches_) {
      result[p.particle] += p.area;
      for (std::size_t b = neighbours_->first[p.particle]; b < neighbours_->first[p.particle + 1]; ++b) {
        const std::size_t j = partner(b);
        const double share =
            weights_->weight[b] * bond(p.particle, b).dot(inverse_moment_[p.particle] * p.offset);
        result[j] += share * p.area;
        result[p.particle] -= share * p.area;
      }
    }
    return result;
  }

  /// Adds to `m` what conjugate gradients find to take away the imbalance `r`. Returns the number of
  /// iterations.
  int solve(Field& m, Field r, double tolerance) {
    const Vector first = dot(r, r);
    Field direction = r, product(size());
    Vector rr = first;
    int iterations = 0;
    const int most = 200 + static_cast<int>(4 * std::sqrt(static_cast<double>(size())));
    const double least = tolerance * tolerance * first.maxCoeff();
    for (; iterations < most && rr.maxCoeff() > least; ++iterations) {
      apply(direction, product);
      const Vector curvature = dot(direction, product);
      Vector step = Vector::Zero(), turn = Vector::Zero();
      for (int c = 0; c < 3; ++c) step[c] = rr[c] > least ? rr[c] / curvature[c] : 0;
      each_particle([&](std::size_t i) {
        m[i] += step.cwiseProduct(direction[i]);
        r[i] -= step.cwiseProduct(product[i]);
      });
      const Vector next = dot(r, r);
      for (int c = 0; c < 3; ++c) turn[c] = rr[c] > 0 ? next[c] / rr[c] : 0;
      each_particle([&](std::size_t i) { direction[i] = r[i] + turn.cwiseProduct(direction[i]); });
      rr = next;
    }
    return iterations;
  }

  static double largest(const Field& field) {
    double most = 0;
    for (const Vector& v : field) most = std::max(most, v.norm());
    return most;
  }

 private:
  struct Patch {
    std::size_t particle;
    Vector offset, area;
  };

  std::size_t partner(std::size_t b) const { return static_cast<std::size_t>(neighbours_->partner[b]); }
  Vector bond(std::size_t i, std::size_t b) const { return place_[partner(b)] - place_[i]; }

  template <class Use>
  void each_particle(const Use& use) const {
    parallel::for_each_share(threads_, size(), [&](int, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) use(i);
    });
  }

  /// Componentwise sums over particles, in runs of one length whatever the number of threads.
  Vector dot(const Field& a, const Field& b) const {
    constexpr std::size_t run = 4096;
    std::vector<Vector> part((size() + run - 1) / run, Vector::Zero());
    parallel::for_each_share(threads_, part.size(), [&](int, std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        for (std::size_t i = p * run; i < std::min(size(), (p + 1) * run); ++i)
          part[p] += a[i].cwiseProduct(b[i]);
      }
    });
    Vector sum = Vector::Zero();
    for (const Vector& p : part) sum += p;
    return sum;
  }

  /// What multipliers `m` add to the nodal sums: for each component c of them
  ///   y_k = sum_j w V_j V_k ((V_j a_j + V_k a_k) . xi - (V_j + V_k) (m_j - m_k)),
  ///   a_i = K_i^-1 sum_j w V_j (m_j - m_i) xi.
  void apply(const Field& m, Field& y) {
    each_particle([&](std::size_t i) {
      Matrix sum = Matrix::Zero();  // row c: of component c
      for (std::size_t b = neighbours_->first[i]; b < neighbours_->first[i + 1]; ++b)
        sum += weights_->weight[b] * (m[partner(b)] - m[i]) * bond(i, b).transpose();
      slope_[i] = volume_[i] * sum * inverse_moment_[i];
    });
    each_particle([&](std::size_t k) {
      Vector sum = Vector::Zero();
      for (std::size_t b = neighbours_->first[k]; b < neighbours_->first[k + 1]; ++b) {
        const std::size_t j = partner(b);
        sum += weights_->weight[b] *
               ((slope_[j] + slope_[k]) * bond(k, b) - (volume_[j] + volume_[k]) * (m[j] - m[k]));
      }
      y[k] = volume_[k] * sum;
    });
  }

  const Neighbours* neighbours_;
  GradientWeights* weights_;
  int threads_;
  Field place_;
  std::vector<double> volume_;
  std::vector<Matrix> inverse_moment_, slope_;
  std::vector<Patch> patches_;
};

}  // namespace

double influence(double ratio) {
  constexpr double least = 1e-3;
  if (ratio >= 1) return least;
  const double rest = 1 - ratio;
  return least + (ratio < 0.5 ? 1 - 6 * ratio * ratio * rest : 2 * rest * rest * rest);
}

GradientWeights find_gradient_weights(const ParticleSet& set, const Neighbours& neighbours, double horizon,
                                      double tolerance) {
  GradientWeights weights;
  Consistency problem(set, neighbours, weights, horizon);
  Field m(set.size(), Vector::Zero());
  weights.iterations = problem.solve(m, problem.imbalance(m), tolerance);
  const Field rest = problem.imbalance(m);
  weights.imbalance = Consistency::largest(rest);
  for (const Vector& v : m) weights.multiplier.push_back({v[0], v[1], v[2]});
  return weights;
}

}  // namespace rhexis::peridynamics
