// SPDX-License-Identifier: BSD-3-Clause
// Bonds that a thread evaluates once for both of their ends, and those that each end evaluates for itself.
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>

#include "peridynamics/engine/body.hpp"
#include "support/vessels.hpp"

namespace rhexis::peridynamics {
namespace {

/// Bit of a bond in saved words: of `row` of the whole body, bond `b` of all columns' (one rank).
bool intact(const Body::Saved& saved, const TablePart& table, std::int64_t b, std::int64_t row) {
  return saved.words[static_cast<std::size_t>(b * table.width + row / 16)] >> (row % 16) & 1;
}

/// A wide tube, which threads share by columns, or a slender rod, which they share by rows; the last block of
/// 16 rows is not full.
class Threads : public testing::TestWithParam<std::tuple<int, const char*, const char*>> {
 protected:
  void SetUp() override { omp_set_num_threads(std::get<0>(GetParam())); }
  void TearDown() override { omp_set_num_threads(before_); }
  static BodySetup setup(const std::string& law = "pmb") {
    const bool rod = std::string(std::get<2>(GetParam())) == "rod";
    Parameters p = test::paper_vessel(rod ? 25e-3 : 3.7e-3);
    if (rod) {
      p.inner_radius = 1e-6;
      p.outer_radius = 3e-4;
    } else {
      p.cross_section = Arrangement::polar;  // unequal volumes
    }
    p.ends = value_of<EndCondition>(std::get<1>(GetParam())).value();
    p.critical_stretch = 0.05;
    p.law.name = law;
    return test::setup_of(p, 1e-7);
  }

 private:
  int before_ = omp_get_max_threads();
};
INSTANTIATE_TEST_SUITE_P(SharedBonds, Threads,
                         testing::Combine(testing::Values(1, 2, 4, 1000),  // more than there are columns
                                          testing::Values("clamped", "axial_periodic"),
                                          testing::Values("tube", "rod")));

TEST_P(Threads, BothEndsKnowThatABondIsBroken) {
  const BodySetup setup = Threads::setup();
  const auto body = make_body(BodySetup(setup), test::self());
  body->set_state(test::sample(*body, test::wild(setup.lattice.spacing)), test::sample(*body, test::nothing));
  std::int64_t told = 0;
  for (int i = 0; i < 30; ++i) told += body->advance(0, 0).broken;
  const Body::Saved saved = body->save();
  const TablePart table = body->word_table();
  const BondFamilies& f = *setup.families;
  std::int64_t broken = 0;
  for (std::size_t c = 0; c + 1 < f.first.size(); ++c) {
    for (std::int64_t b = f.first[c]; b < f.first[c + 1]; ++b) {
      const Bond& bond = f.bonds[static_cast<std::size_t>(b)];
      const std::span<const Bond> theirs = f.of(static_cast<std::size_t>(bond.other));
      const auto opposite = std::find_if(theirs.begin(), theirs.end(), [&](const Bond& other) {
        return other.other == static_cast<std::int32_t>(c) && other.row_offset == -bond.row_offset;
      });
      const std::int64_t back = f.first[static_cast<std::size_t>(bond.other)] + (opposite - theirs.begin());
      for (std::int64_t row = 0; row < setup.lattice.rows; ++row) {
        std::int64_t there = row + bond.row_offset;
        if (setup.ends == EndCondition::axial_periodic) {
          there = (there + setup.lattice.rows) % setup.lattice.rows;
        } else if (there < 0 || there >= setup.lattice.rows) {
          continue;
        }
        const bool here = intact(saved, table, b, row);
        ASSERT_EQ(here, intact(saved, table, back, there)) << c << ' ' << row << ' ' << bond.row_offset;
        broken += here ? 0 : 1;
      }
    }
  }
  EXPECT_GT(broken, 100);
  EXPECT_EQ(told, broken);
}

TEST_P(Threads, SharedBondsGiveWhatEachEndFindsForItself) {
  const BodySetup setup = Threads::setup();
  const auto observed = [&](int threads) {
    omp_set_num_threads(threads);
    const auto body = make_body(BodySetup(setup), test::self());
    body->set_state(test::sample(*body, test::wild(8 * setup.lattice.spacing)),
                    test::sample(*body, test::nothing));
    const Observation& seen = body->observe(0);
    return std::pair(seen, body->totals());
  };
  const auto [shared, all] = observed(std::get<0>(GetParam()));
  const auto [alone, expected] = observed(1000);  // in as many parts as there are columns
  EXPECT_EQ(shared.force_density, alone.force_density);
  EXPECT_EQ(shared.strain_energy_density, alone.strain_energy_density);
  EXPECT_EQ(shared.damage, alone.damage);
  EXPECT_EQ(all.strain, expected.strain);
  EXPECT_EQ(all.broken_bonds, expected.broken_bonds);
  EXPECT_EQ(all.crushed_bonds, expected.crushed_bonds);
  EXPECT_GT(all.broken_bonds, 0);
  EXPECT_GT(all.crushed_bonds, 0);
}

TEST_P(Threads, TornAndRestoredBodyGoesOnAsWithOneThread) {
  for (const char* law : {"pmb", "lps"}) {
    const BodySetup setup = Threads::setup(law);
    const auto torn = [&](int threads) {
      omp_set_num_threads(threads);
      const auto body = make_body(BodySetup(setup), test::self()),
                 other = make_body(BodySetup(setup), test::self());
      const double spacing = setup.lattice.spacing;
      for (const auto& [b, u] : {std::pair(body.get(), spacing), std::pair(other.get(), 2 * spacing)}) {
        b->set_state(test::sample(*b, test::wild(u)), test::sample(*b, test::wild(u / 1e-6)));
        for (int i = 0; i < 10; ++i) b->advance(0, 0);  // each breaks other bonds
      }
      other->restore(body->save());
      std::int64_t broken = 0;
      for (int i = 0; i < 10; ++i) broken += other->advance(0, 0).broken;
      EXPECT_GT(broken, 0) << law;
      return other->save();
    };
    const Body::Saved alone = torn(1), shared = torn(std::get<0>(GetParam()));
    EXPECT_EQ(alone.displacement, shared.displacement) << law;
    EXPECT_EQ(alone.words, shared.words) << law;
  }
}

}  // namespace
}  // namespace rhexis::peridynamics
