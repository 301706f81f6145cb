// SPDX-License-Identifier: BSD-3-Clause
// What there is of a wall, by formulas, against what is made of it.
#include <gtest/gtest.h>

#include <set>

#include "peridynamics/wall_memory.hpp"
#include "support/vessels.hpp"

namespace rhexis::peridynamics {
namespace {

struct Made {
  double columns, rows, bonds, neighbours;
};

Made made(const Parameters& p) {
  const Lattice lattice = make_lattice(p);
  const BondFamilies families = find_families(lattice);
  double neighbours = 0;
  for (std::size_t c = 0; c < lattice.section.size(); ++c) {
    std::set<std::int32_t> others{static_cast<std::int32_t>(c)};
    for (const Bond& bond : families.of(c)) others.insert(bond.other);
    neighbours += static_cast<double>(others.size());
  }
  const auto columns = static_cast<double>(lattice.section.size());
  return {columns, static_cast<double>(lattice.rows), static_cast<double>(families.bonds.size()),
          neighbours / columns};
}

Parameters vessel(const char* cross_section, double spacing, double ratio) {
  Parameters p = test::paper_vessel();
  p.cross_section = value_of<Arrangement>(cross_section).value();
  p.spacing = spacing;
  p.horizon = {};
  p.horizon_ratio = ratio;
  p.length = 20.4 * spacing;
  resolve(p);
  return p;
}

TEST(WallSize, IsExact) {
  for (const char* cross_section : {"polar", "lattice"}) {
    for (double ratio : {2.0, 3.0, 3.5, 6.0}) {
      for (double spacing : {0.45e-3, 1e-4, 5e-5}) {
        const Parameters p = vessel(cross_section, spacing, ratio);
        const WallSize size = wall_size(p);
        const Made real = made(p);
        EXPECT_EQ(size.columns, real.columns) << cross_section << ' ' << ratio << ' ' << spacing;
        EXPECT_EQ(size.rows, real.rows);
        EXPECT_EQ(size.bonds, real.bonds) << cross_section << ' ' << ratio << ' ' << spacing;
        EXPECT_NEAR(size.neighbours, real.neighbours, 1e-9);
      }
    }
  }
}

TEST(WallSize, OfALatticeThatIsShifted) {
  for (double shift : {0.0, 0.3, 1.0}) {
    Parameters p = vessel("lattice", 1e-4, 3);
    p.lattice_shift = {shift, 0.5 * shift};
    EXPECT_EQ(wall_size(p).columns, made(p).columns) << shift;
    EXPECT_EQ(wall_size(p).bonds, made(p).bonds) << shift;
  }
}

TEST(WallMemory, OfWallsBeyondAnyMachineIsKnownAtOnce) {
  Parameters p = vessel("polar", 1e-4, 3.5);
  p.outer_radius = 2;
  const WallSize size = wall_size(p);
  EXPECT_GT(size.columns, 1e8);
  EXPECT_GT(wall_memory(p, size, {}).run, 1e12);
}

}  // namespace
}  // namespace rhexis::peridynamics
