// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/graph/boomer_amg.hpp"

#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_parcsr_ls.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace rhexis::hemodynamics {
namespace {

void check(HYPRE_Int error, const char* what) {
  if (error == 0) return;
  char text[256];
  HYPRE_DescribeError(error, text);
  HYPRE_ClearAllErrors();
  throw RunError("hypre fails in " + std::string(what) + ": " + text);
}

}  // namespace

struct BoomerAmg::Handles {
  HYPRE_IJMatrix matrix = nullptr;
  HYPRE_IJVector right = nullptr, left = nullptr;
  HYPRE_ParCSRMatrix rows = nullptr;
  HYPRE_ParVector right_rows = nullptr, left_rows = nullptr;
  HYPRE_Solver cycle = nullptr;
  std::vector<HYPRE_BigInt> own, columns;
};

BoomerAmg::BoomerAmg(parallel::Communicator comm, std::int64_t first_row, std::size_t rows)
    : handles_(std::make_unique<Handles>()) {
  static const bool started = HYPRE_Init() == 0;
  (void)started;
  auto& h = *handles_;
  h.own.resize(rows);
  const auto first = static_cast<HYPRE_BigInt>(first_row);
  const HYPRE_BigInt last = first + static_cast<HYPRE_BigInt>(rows) - 1;
  std::iota(h.own.begin(), h.own.end(), first);
  check(HYPRE_IJMatrixCreate(comm.handle(), first, last, first, last, &h.matrix), "making a matrix");
  HYPRE_IJMatrixSetObjectType(h.matrix, HYPRE_PARCSR);
  HYPRE_IJMatrixInitialize(h.matrix);
  for (HYPRE_IJVector* vector : {&h.right, &h.left}) {
    check(HYPRE_IJVectorCreate(comm.handle(), first, last, vector), "making a vector");
    HYPRE_IJVectorSetObjectType(*vector, HYPRE_PARCSR);
    HYPRE_IJVectorInitialize(*vector);
  }
}

BoomerAmg::~BoomerAmg() {
  if (handles_->cycle != nullptr) HYPRE_BoomerAMGDestroy(handles_->cycle);
  HYPRE_IJVectorDestroy(handles_->left);
  HYPRE_IJVectorDestroy(handles_->right);
  HYPRE_IJMatrixDestroy(handles_->matrix);
}

void BoomerAmg::add(std::int64_t row, std::span<const std::int64_t> columns, std::span<const double> values) {
  handles_->columns.assign(columns.begin(), columns.end());
  auto count = static_cast<HYPRE_Int>(values.size());
  const auto hypre_row = static_cast<HYPRE_BigInt>(row);
  check(HYPRE_IJMatrixAddToValues(handles_->matrix, 1, &count, &hypre_row, handles_->columns.data(),
                                  values.data()),
        "filling a matrix");
}

void BoomerAmg::finish() {
  auto& h = *handles_;
  check(HYPRE_IJMatrixAssemble(h.matrix), "assembling a matrix");
  HYPRE_IJMatrixGetObject(h.matrix, reinterpret_cast<void**>(&h.rows));
  for (const HYPRE_IJVector vector : {h.right, h.left}) {
    const std::vector<double> zeros(h.own.size());
    HYPRE_IJVectorSetValues(vector, static_cast<HYPRE_Int>(h.own.size()), h.own.data(), zeros.data());
    HYPRE_IJVectorAssemble(vector);
  }
  HYPRE_IJVectorGetObject(h.right, reinterpret_cast<void**>(&h.right_rows));
  HYPRE_IJVectorGetObject(h.left, reinterpret_cast<void**>(&h.left_rows));
  HYPRE_BoomerAMGCreate(&h.cycle);
  HYPRE_BoomerAMGSetPrintLevel(h.cycle, 0);
  HYPRE_BoomerAMGSetMaxIter(h.cycle, 1);
  HYPRE_BoomerAMGSetTol(h.cycle, 0);
  HYPRE_BoomerAMGSetStrongThreshold(h.cycle, 0.25);
  HYPRE_BoomerAMGSetCoarsenType(h.cycle, 8);  // PMIS
  HYPRE_BoomerAMGSetInterpType(h.cycle, 6);   // extended+i
  HYPRE_BoomerAMGSetPMaxElmts(h.cycle, 4);
  HYPRE_BoomerAMGSetRelaxType(h.cycle, 8);  // symmetric Gauss-Seidel, so that the cycle is symmetric
  HYPRE_BoomerAMGSetMaxRowSum(h.cycle, 1);  // every row of a Laplacian but those at fixed pressures sums to 0
  check(HYPRE_BoomerAMGSetup(h.cycle, h.rows, h.right_rows, h.left_rows), "BoomerAMG's set-up");
}

void BoomerAmg::apply(std::span<const double> residual, std::span<double> result) {
  auto& h = *handles_;
  const auto count = static_cast<HYPRE_Int>(h.own.size());
  HYPRE_IJVectorSetValues(h.right, count, h.own.data(), residual.data());
  HYPRE_ParVectorSetConstantValues(h.left_rows, 0);
  HYPRE_BoomerAMGSolve(h.cycle, h.rows, h.right_rows, h.left_rows);
  HYPRE_ClearAllErrors();  // one cycle does not converge, and says so
  HYPRE_IJVectorGetValues(h.left, count, h.own.data(), result.data());
}

}  // namespace rhexis::hemodynamics
