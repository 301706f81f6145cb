// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/graph/preconditioner.hpp"

#include <Eigen/SparseCholesky>
#include <cassert>
#include <vector>

#include "core/error.hpp"
#include "hemodynamics/steady/graph/approximate_cholesky.hpp"
#include "hemodynamics/steady/graph/boomer_amg.hpp"

namespace rhexis::hemodynamics {
namespace {

class Jacobi final : public Preconditioner {
 public:
  explicit Jacobi(const CoreSystem& system) : inverse_(system.unknowns()) {
    for (std::size_t j = 0; j < inverse_.size(); ++j) inverse_[j] = 1 / system.weight_sum(j);
  }
  void apply(std::span<const double> residual, std::span<double> result) override {
    for (std::size_t j = 0; j < inverse_.size(); ++j) result[j] = inverse_[j] * residual[j];
  }

 private:
  std::vector<double> inverse_;
};

using Matrix = Eigen::SparseMatrix<double>;

/// Lower triangle, the diagonal raised by the given fraction of itself.
Matrix lower_triangle(const CoreSystem& system, double raised) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(system.entries() / 2 + system.unknowns());
  for (std::size_t j = 0; j < system.unknowns(); ++j) {
    const auto row = static_cast<int>(j);
    entries.emplace_back(row, row, system.weight_sum(j) * (1 + raised));
    for (std::size_t k = 0; k < system.neighbours(j).size(); ++k) {
      if (system.neighbours(j)[k] >= j) continue;
      entries.emplace_back(row, static_cast<int>(system.neighbours(j)[k]), -system.weights(j)[k]);
    }
  }
  const auto size = static_cast<Eigen::Index>(system.unknowns());
  Matrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

class Ldlt final : public Preconditioner {
 public:
  /// Differences of the diagonal can leave a pivot that is all rounding; a slightly raised diagonal then
  /// keeps the factor positive, and conjugate gradients make up for it.
  explicit Ldlt(const CoreSystem& system) {
    for (const double raised : {0.0, 1e-14, 1e-12, 1e-10}) {
      factor_.compute(lower_triangle(system, raised));
      if (factor_.info() == Eigen::Success && factor_.vectorD().minCoeff() > 0) return;
    }
    throw RunError("solver 'ldlt' fails at this contrast between conductances: use 'approximate_cholesky'");
  }
  void apply(std::span<const double> residual, std::span<double> result) override {
    const auto size = factor_.rows();
    Eigen::Map<Eigen::VectorXd>(result.data(), size) =
        factor_.solve(Eigen::Map<const Eigen::VectorXd>(residual.data(), size));
  }

 private:
  Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<int>> factor_;
};

class Amg final : public Preconditioner {
 public:
  explicit Amg(const CoreSystem& system) : cycle_(parallel::Communicator::self(), 0, system.unknowns()) {
    std::vector<std::int64_t> columns;
    std::vector<double> values;
    for (std::size_t j = 0; j < system.unknowns(); ++j) {
      columns.assign(1, static_cast<std::int64_t>(j));
      values.assign(1, system.weight_sum(j));
      for (std::size_t k = 0; k < system.neighbours(j).size(); ++k) {
        const std::uint32_t neighbour = system.neighbours(j)[k];
        if (neighbour >= system.unknowns()) continue;
        columns.push_back(neighbour);
        values.push_back(-system.weights(j)[k]);
      }
      cycle_.add(static_cast<std::int64_t>(j), columns, values);
    }
    cycle_.finish();
  }
  void apply(std::span<const double> residual, std::span<double> result) override {
    cycle_.apply(residual, result);
  }

 private:
  BoomerAmg cycle_;
};

}  // namespace

std::unique_ptr<Preconditioner> make_preconditioner(const CoreSystem& system, GraphSolver solver) {
  switch (solver) {
    case GraphSolver::jacobi:
      return std::make_unique<Jacobi>(system);
    case GraphSolver::ldlt:
      return std::make_unique<Ldlt>(system);
    case GraphSolver::amg:
      return std::make_unique<Amg>(system);
    case GraphSolver::approximate_cholesky:
      return std::make_unique<ApproximateCholesky>(system);
    case GraphSolver::automatic:
    case GraphSolver::elimination:
      break;
  }
  assert(false);
  return nullptr;
}

}  // namespace rhexis::hemodynamics
