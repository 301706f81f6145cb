// SPDX-License-Identifier: BSD-3-Clause
#include "parallel/partition.hpp"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "core/error.hpp"

namespace rhexis::parallel {
namespace {

/// What cuts cost in the paper's wall, 548 columns with 130 bonds a particle.
constexpr CutCosts paper{.bonds_across = 400, .halo_columns = 20, .halo_rows = 3};

TEST(Partition, CoversEveryParticleOnce) {
  for (int ranks : {1, 2, 3, 4, 6, 7, 12, 16}) {
    const std::int64_t rows = 97;
    const std::vector<double> weights(40, 1.0);
    const Partition p = make_partition(ranks, weights, rows, paper);
    ASSERT_EQ(p.ranks(), ranks);
    std::int64_t count = 0;
    for (int r = 0; r < ranks; ++r) {
      const std::int64_t columns = p.past_column(r) - p.first_column(r), own = p.past_row(r) - p.first_row(r);
      ASSERT_GT(columns, 0);
      ASSERT_GT(own, 0);
      ASSERT_EQ(p.first_row(r) % block_rows, 0);
      count += columns * own;
      ASSERT_EQ(p.rank_of(p.first_column(r), p.first_row(r)), r);
      ASSERT_EQ(p.rank_of(p.past_column(r) - 1, p.past_row(r) - 1), r);
    }
    EXPECT_EQ(count, 40 * rows);
  }
}

TEST(Partition, BalancesUnequalColumns) {
  std::vector<double> weights(100, 1.0);
  for (int i = 0; i < 10; ++i) weights[i] = 10;
  const Partition p = make_partition(2, weights, 16, {});
  ASSERT_EQ(p.column_parts(), 2);
  EXPECT_NEAR(static_cast<double>(p.column_start[1]), 9.5, 1);
}

TEST(Partition, LongVesselIsCutAcrossItsAxis) {
  const Partition p = make_partition(16, std::vector<double>(548, 130.0), 10000, paper);
  EXPECT_EQ(p.block_parts(), 16);
}

TEST(Partition, ShortVesselIsCutLengthwise) {
  // Across the axis each half would evaluate a tenth more: the bonds that lead into it.
  const Partition p = make_partition(2, std::vector<double>(548, 130.0), 192, paper);
  EXPECT_EQ(p.column_parts(), 2);
}

TEST(Partition, MoreRanksThanPiecesAreRefused) {
  EXPECT_THROW(make_partition(5, std::vector<double>(2, 1.0), 32, {}), InputError);
}

}  // namespace
}  // namespace rhexis::parallel
