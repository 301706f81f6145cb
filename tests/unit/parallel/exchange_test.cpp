// SPDX-License-Identifier: BSD-3-Clause
// Records go where they were sent, in order; sums of shared values are those of all who hold a point.
#include "parallel/exchange.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "core/error.hpp"
#include "parallel/shared_values.hpp"
#include "parallel/together.hpp"

namespace rhexis::parallel {
namespace {

struct Record {
  int from, to, number;
};

TEST(Exchange, AllToAllKeepsOrder) {
  const auto world = Communicator::world();
  const int rank = world.rank(), ranks = world.size();
  std::vector<std::vector<Record>> outgoing(static_cast<std::size_t>(ranks));
  for (int to = 0; to < ranks; ++to) {
    for (int n = 0; n < to + rank; ++n) outgoing[static_cast<std::size_t>(to)].push_back({rank, to, n});
  }
  const auto incoming = all_to_all(world, outgoing);
  for (int from = 0; from < ranks; ++from) {
    const auto records = incoming.of(from);
    ASSERT_EQ(records.size(), static_cast<std::size_t>(rank + from));
    for (int n = 0; n < rank + from; ++n) {
      const Record& record = records[static_cast<std::size_t>(n)];
      EXPECT_EQ(record.from, from);
      EXPECT_EQ(record.to, rank);
      EXPECT_EQ(record.number, n);
    }
  }
}

TEST(Exchange, AllGather) {
  const auto world = Communicator::world();
  const auto all = all_gather(world, std::vector<int>(static_cast<std::size_t>(world.rank()), world.rank()));
  for (int from = 0; from < world.size(); ++from) {
    ASSERT_EQ(all.of(from).size(), static_cast<std::size_t>(from));
    for (const int value : all.of(from)) EXPECT_EQ(value, from);
  }
}

TEST(SharedValues, OwnersSumAndCopy) {
  // Point 0 is on all ranks and owned by the last; point 1 is each rank's own.
  const auto world = Communicator::world();
  const int last = world.size() - 1;
  std::vector<SharedLink> links;
  for (int other = 0; other < last; ++other) {
    if (world.rank() == last) links.push_back({other, {0}, {}});
  }
  if (world.rank() != last) links.push_back({last, {}, {0}});
  SharedValues shared(world, links);
  std::vector<double> values{world.rank() + 1.0, 100.0 + world.rank()};
  shared.add_to_owner(values);
  if (world.rank() == last) {
    EXPECT_EQ(values[0], world.size() * (world.size() + 1) / 2.0);
  } else {
    EXPECT_EQ(values[0], world.rank() + 1.0);
  }
  shared.copy_from_owner(values);
  EXPECT_EQ(values[0], world.size() * (world.size() + 1) / 2.0);
  EXPECT_EQ(values[1], 100.0 + world.rank());
}

TEST(Together, OneRanksErrorIsThrownByAll) {
  const auto world = Communicator::world();
  const bool is_last = world.rank() == world.size() - 1;
  EXPECT_THROW(together(world,
                        [&] {
                          if (is_last) throw InputError("wrong");
                        }),
               InputError);
  EXPECT_THROW(together(world,
                        [&] {
                          if (is_last) throw RunError("full");
                        }),
               RunError);
  EXPECT_THROW(together(world,
                        [&] {
                          if (is_last) throw InputError("wrong");
                          throw RunError("full");
                        }),
               InputError);  // which says more
  EXPECT_NO_THROW(together(world, [] {}));
}

}  // namespace
}  // namespace rhexis::parallel
