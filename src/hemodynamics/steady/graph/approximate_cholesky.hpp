// SPDX-License-Identifier: BSD-3-Clause
/// A randomised approximate Cholesky factor of a Laplacian: R. Kyng & S. Sachdeva, Approximate Gaussian
/// elimination for Laplacians, FOCS 2016; Y. Gao, R. Kyng & D. A. Spielman, Robust and practical solution of
/// Laplacian equations by approximate elimination, 2023.
///
/// All fixed pressures are one ground vertex, eliminated last. Vertices are eliminated in the order of
/// (about) least degree. Eliminating v with neighbours of weights w_1 <= ... <= w_d, W their sum, would add
/// the clique of weights w_i w_k / W. Instead every i < d draws one k > i with probability w_k / S_i, S_i =
/// sum_{k>i} w_k, and one vessel i-k of weight w_i S_i / W is added: right in expectation, and nothing fills.
///
///   A ~ L D L^T,   L_uv = -w_u / W_v,   D_v = W_v
///
/// Only weights are added and multiplied, the diagonal is never stored, so no contrast of conductances makes
/// the factor indefinite. Random numbers are Philox's of a fixed key, counted by vertex: the same factor on
/// every machine.
#pragma once

#include <cstdint>
#include <vector>

#include "hemodynamics/steady/graph/preconditioner.hpp"

namespace rhexis::hemodynamics {

class ApproximateCholesky final : public Preconditioner {
 public:
  explicit ApproximateCholesky(const CoreSystem& system);
  void apply(std::span<const double> residual, std::span<double> result) override;
  std::size_t entries() const { return row_.size(); }

 private:
  std::vector<std::uint32_t> order_;  // [n] vertex eliminated as the n-th; rows below are such numbers
  std::vector<std::uint32_t> first_;  // [n+1]
  std::vector<std::uint32_t> row_;    // neighbours, all eliminated later; the ground is left out
  std::vector<double> share_;         // w_u / W_v
  std::vector<double> pivot_;         // [n] W_v
  std::vector<double> work_;          // [n]
};

}  // namespace rhexis::hemodynamics
