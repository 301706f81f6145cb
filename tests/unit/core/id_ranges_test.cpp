// SPDX-License-Identifier: BSD-3-Clause
#include "core/id_ranges.hpp"

#include <gtest/gtest.h>

namespace rhexis {
namespace {

TEST(IdRanges, RangesThatTouchBecomeOneAndEmptyOnesNone) {
  IdRanges ids{.global_count = 100};
  ids.add({10, 5});
  ids.add({15, 0});
  ids.add({15, 5});
  ids.add({40, 1});
  EXPECT_EQ(ids.ranges, (std::vector<IdRange>{{10, 10}, {40, 1}}));
  EXPECT_EQ(ids.local_count(), 11);
  EXPECT_EQ(IdRanges{.global_count = 100}.local_count(), 0);
}

TEST(TablePart, CountsTheColumnsOfItsRows) {
  const TablePart part{
      .rows = {.global_count = 9, .ranges = {{2, 3}, {7, 1}}}, .width = 8, .first = 2, .count = 5};
  EXPECT_EQ(part.local_count(), 20);
}

}  // namespace
}  // namespace rhexis
