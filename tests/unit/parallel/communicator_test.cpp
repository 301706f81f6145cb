// SPDX-License-Identifier: BSD-3-Clause
#include "parallel/communicator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "parallel/exact_sum.hpp"

namespace rhexis::parallel {
namespace {

TEST(Communicator, FailureOnOneRankIsKnownToAll) {
  const auto world = Communicator::world();
  EXPECT_EQ(world.first_non_empty(""), "");
  const int last = world.size() - 1;
  EXPECT_EQ(world.first_non_empty(world.rank() == last ? "disk full" : ""), "disk full");
}

TEST(Communicator, ReducesAndBroadcasts) {
  const auto world = Communicator::world();
  EXPECT_EQ(world.all_reduce(std::int64_t{1}, Reduce::sum), world.size());
  EXPECT_EQ(world.all_reduce(static_cast<double>(world.rank()), Reduce::max), world.size() - 1);
  EXPECT_EQ(world.broadcast(world.is_root() ? "text" : ""), "text");
  struct Pair {
    double x;
    std::int64_t n;
  };
  const Pair pair = world.broadcast(world.is_root() ? Pair{0.5, 7} : Pair{});
  EXPECT_EQ(pair.x, 0.5);
  EXPECT_EQ(pair.n, 7);
  EXPECT_EQ(world.node_count(), 1);
}

TEST(MpiLibrary, LeavesTheMpiOfOthersRunning) {
  int argc = 0;
  char** argv = nullptr;
  { const MpiLibrary second(argc, argv); }
  EXPECT_EQ(Communicator::world().all_reduce(std::int64_t{1}, Reduce::sum), Communicator::world().size());
}

TEST(ThreadCount, ReturnsToTheCallers) {
  const int before = thread_count();
  ASSERT_EQ(setenv("OMP_NUM_THREADS", "3", 1), 0);
  {
    const ThreadCount three;
    EXPECT_EQ(thread_count(), 3);
  }
  EXPECT_EQ(thread_count(), before);
}

TEST(ExactSum, DoesNotDependOnOrderOrRanks) {
  const auto world = Communicator::world();
  ExactSum mine(1.0), all(1.0), backwards(1.0);
  constexpr int terms = 1000;
  const auto term = [](int i) { return std::sin(i * 1.7) * std::pow(10.0, i % 12 - 8); };
  for (int i = 0; i < terms; ++i) {
    all.add(term(i));
    backwards.add(term(terms - 1 - i));
    if (i % world.size() == world.rank()) mine.add(term(i));
  }
  EXPECT_EQ(all.value(), backwards.value());
  EXPECT_EQ(mine.value(world), all.value());
  double plain = 0;
  for (int i = 0; i < terms; ++i) plain += term(i);
  EXPECT_NEAR(all.value(), plain, 1e-10);
}

TEST(ExactSum, WithoutScaleSumsAllTheSame) {
  ExactSum sum(0.0);
  sum.add(0.0);
  EXPECT_EQ(sum.value(), 0.0);
  sum.add(0.5);
  EXPECT_EQ(sum.value(), 0.5);
}

TEST(ExactSum, TermsAreWholeDownToTheQuantum) {
  for (const double sign : {1.0, -1.0}) {
    for (int exponent = -27; exponent < 20; ++exponent) {  // the last bit of the smallest is 2^-79
      ExactSum sum(1.0);
      const double term = sign * std::ldexp(0x1.23456789abcdfp0, exponent);
      sum.add(term);
      EXPECT_EQ(sum.value(), term);
    }
    ExactSum cut(1.0);
    cut.add(sign * 0x1.8p-79);
    EXPECT_EQ(cut.value(), sign * 0x1p-79);
  }
}

TEST(ExactSum, GoesOnFromItsPartsWithoutLoss) {
  const auto world = Communicator::world();
  for (const double sign : {1.0, -1.0}) {
    ExactSum whole(1.0), early(1.0);
    for (int i = 1; i < 200; ++i) {
      whole.add(sign / i);
      early.add(sign / i);
    }
    const std::array<double, 2> parts = early.parts(world);
    EXPECT_NE(parts[1], 0);
    ExactSum late(1.0);
    for (const double part : parts) late.add(world.is_root() ? part : 0.0);
    // Far smaller than the last digit of the first part: it tells whether the second is there.
    for (int i = 0; i < 1000; ++i) {
      whole.add(sign * 1e-18);
      late.add(sign * 1e-18);
    }
    EXPECT_EQ(late.parts(world), whole.parts(world));
  }
}

TEST(ExactSum, NegativeTotalsAndOverflow) {
  const auto world = Communicator::world();
  ExactSum sum(1.0);
  sum.add(-3.25);
  EXPECT_EQ(sum.value(world), -3.25 * world.size());
  sum.add(std::nan(""));
  EXPECT_TRUE(std::isinf(sum.value(world)));
}

}  // namespace
}  // namespace rhexis::parallel
