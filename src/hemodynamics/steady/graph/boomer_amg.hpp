// SPDX-License-Identifier: BSD-3-Clause
/// One V-cycle of hypre's BoomerAMG, symmetric, as a preconditioner of conjugate gradients. Rows are spread
/// over the ranks of a communicator in contiguous ranges; everything but `add` is collective. hypre counts
/// rows of all ranks together in 32 bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "parallel/communicator.hpp"

namespace rhexis::hemodynamics {

class BoomerAmg {
 public:
  /// This rank owns rows [first_row, first_row + rows).
  BoomerAmg(parallel::Communicator comm, std::int64_t first_row, std::size_t rows);
  ~BoomerAmg();

  /// Adds values to one row, of any rank; a column may come several times.
  void add(std::int64_t row, std::span<const std::int64_t> columns, std::span<const double> values);
  void finish();
  /// Over the own rows. Throws RunError where hypre fails.
  void apply(std::span<const double> residual, std::span<double> result);

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace rhexis::hemodynamics
