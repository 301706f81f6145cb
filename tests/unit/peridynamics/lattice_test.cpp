// SPDX-License-Identifier: BSD-3-Clause
// Cross-sections and bond families: counts known in closed form or from the paper's case, and symmetry.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <numeric>

#include "core/error.hpp"
#include "peridynamics/bonds/bond_family.hpp"
#include "peridynamics/laws/pmb.hpp"
#include "peridynamics/stability/bond_step.hpp"
#include "support/vessels.hpp"

namespace rhexis::peridynamics {
namespace {

TEST(CrossSection, LatticeOfThePaperHas548Columns) {
  EXPECT_EQ(lattice_cross_section(1.5e-3, 2e-3, 1e-4, 0.5, 0.5).size(), 548u);
}

TEST(CrossSection, NodesExactlyOnTheRadiiCount) {
  // Nodes at distance 1 and 2 spacings: (1,0), (1,1), (2,0) and their images, 12 in all.
  EXPECT_EQ(lattice_cross_section(1e-4, 2e-4, 1e-4, 0, 0).size(), 12u);
}

TEST(CrossSection, PolarFillsTheWallExactly) {
  const CrossSection s = polar_cross_section(1.5e-3, 2e-3, 1e-4);
  const double area = std::accumulate(s.area.begin(), s.area.end(), 0.0);
  EXPECT_NEAR(area / (std::numbers::pi * (4e-6 - 2.25e-6)), 1, 1e-13);
  EXPECT_EQ(s.size(), 5u * 110u);
}

TEST(CrossSection, SpacingFromParticleNumberGivesAboutThatMany) {
  for (const char* kind : {"lattice", "polar"}) {
    Parameters p = test::paper_vessel(10e-3);
    p.cross_section = value_of<Arrangement>(kind).value();
    p.spacing.reset();
    p.particles = 55000;
    p.horizon.reset();
    p.horizon_ratio = 3.5;
    resolve(p);
    EXPECT_NEAR(*p.spacing, std::cbrt(std::numbers::pi * 1.75e-6 * 10e-3 / 55000), 1e-12);
    EXPECT_NEAR(*p.horizon, 3.5 * *p.spacing, 1e-15);
    EXPECT_NEAR(static_cast<double>(make_lattice(p).particles()), 55000, 0.03 * 55000) << kind;
  }
}

TEST(BondFamilies, CountsOfThePaper) {
  Parameters p = test::paper_vessel(10e-3);
  resolve(p);
  const Lattice lattice = make_lattice(p);
  const BondFamilies families = find_families(lattice);
  EXPECT_EQ(lattice.particles(), 54800);
  EXPECT_EQ(count_bonds(lattice, families, false), 3542896);
  EXPECT_EQ(largest_family(lattice, families, false), 160);
}

TEST(BondFamilies, BulkParticleHas178Neighbours) {
  Parameters p = test::paper_vessel(10e-3);
  p.inner_radius = 1e-6;  // a rod
  resolve(p);
  const Lattice lattice = make_lattice(p);
  EXPECT_EQ(largest_family(lattice, find_families(lattice), false), 178);
}

TEST(BondFamilies, EveryBondHasItsExactOpposite) {
  for (const char* kind : {"lattice", "polar"}) {
    Parameters p = test::paper_vessel();
    p.cross_section = value_of<Arrangement>(kind).value();
    resolve(p);
    const Lattice lattice = make_lattice(p);
    const BondFamilies f = find_families(lattice);
    for (std::size_t i = 0; i < lattice.section.size(); ++i) {
      for (std::int64_t b = f.first[i]; b < f.first[i + 1]; ++b) {
        const Bond& bond = f.bonds[b];
        const auto opposite = std::find_if(f.bonds.begin() + f.first[bond.other],
                                           f.bonds.begin() + f.first[bond.other + 1], [&](const Bond& other) {
                                             return other.other == static_cast<std::int32_t>(i) &&
                                                    other.row_offset == -bond.row_offset;
                                           });
        ASSERT_NE(opposite, f.bonds.begin() + f.first[bond.other + 1]);
        for (int k = 0; k < 3; ++k) ASSERT_EQ(opposite->xi[k], -bond.xi[k]);
        ASSERT_EQ(opposite->length, bond.length);
      }
    }
  }
}

TEST(BondFamilies, EarlierBondsComeByColumnAndLaterOnesByRow) {
  Parameters p = test::paper_vessel();
  resolve(p);
  const Lattice lattice = make_lattice(p);
  const BondFamilies f = find_families(lattice);
  for (std::size_t i = 0; i < lattice.section.size(); ++i) {
    const auto own = static_cast<std::int32_t>(i);
    const std::span<const Bond> family = f.of(i);
    for (std::size_t b = 1; b < family.size(); ++b) {
      const Bond &a = family[b - 1], &next = family[b];
      if (!is_forward(next, own)) {
        ASSERT_LT(std::pair(a.other, a.row_offset), std::pair(next.other, next.row_offset));
      } else if (is_forward(a, own)) {
        ASSERT_LT(std::pair(-a.row_offset, a.other), std::pair(-next.row_offset, next.other));
      }
    }
  }
}

TEST(BondFamilies, CountOfAShortBodyIsCountedByHand) {
  // One column of 3 rows, horizon 2.5 spacings: bonds 0-1, 1-2, 0-2.
  Lattice line{{{0.0}, {0.0}, {1.0}}, 3, 1.0, 1.0, 2.5};
  const BondFamilies f = find_families(line);
  EXPECT_EQ(count_bonds(line, f, false), 3);
  EXPECT_EQ(largest_family(line, f, false), 2);
  EXPECT_EQ(f.count(0), 4);
  line.rows = 10;
  EXPECT_EQ(count_bonds(line, f, true), 20);
}

TEST(BondFamilies, CutOfARingIsCountedByHand) {
  // One layer of columns around, horizon 1.5 spacings: a column has three bonds to each of its neighbours.
  Lattice ring{polar_cross_section(0.95, 1.05, 0.1), 3, 0.1, 0.1, 0.15};
  const ColumnCut cut = mean_column_cut(find_families(ring));
  EXPECT_EQ(cut.columns, 1);
  EXPECT_EQ(cut.bonds, 3);
  // 2.1 spacings: one to the next but one besides, which goes through two cuts.
  ring.horizon = 0.21;
  const ColumnCut wider = mean_column_cut(find_families(ring));
  EXPECT_EQ(wider.columns, 2);
  EXPECT_EQ(wider.bonds, 3 + 2 * 1);
}

TEST(StableTimeStep, TendsToTheContinuumValue) {
  // sum V/|xi| -> integral 4 pi r dr = 2 pi delta^2 in the bulk, at 3.5 spacings within a few per cent; a
  // third of it in each direction.
  Parameters p = test::paper_vessel(10e-3);
  p.inner_radius = 1e-6;
  resolve(p);
  const Lattice lattice = make_lattice(p);
  const double c = Pmb::bond_constant(p.young_modulus, *p.horizon);
  const double trace = c * 2 * std::numbers::pi * *p.horizon * *p.horizon;
  const auto step = [&](double critical_stretch) {
    return stable_bond_step(lattice, find_families(lattice), c, p.density, critical_stretch);
  };
  EXPECT_NEAR(step(0) / std::sqrt(6 * p.density / trace), 1, 0.04);
  EXPECT_NEAR(step(0.25) / step(0), 1 / std::sqrt(1.25), 1e-12);
  EXPECT_NEAR(step(5) / std::sqrt(2 * p.density / trace), 1, 0.04);
}

TEST(Parameters, InconsistentValuesNameTheirKey) {
  const auto key_of = [](auto change) -> std::string {
    Parameters p = test::paper_vessel();
    change(p);
    try {
      resolve(p);
    } catch (const InputError& error) {
      return error.key;
    }
    return "accepted";
  };
  EXPECT_EQ(key_of([](Parameters&) {}), "accepted");
  EXPECT_EQ(key_of([](Parameters& p) { p.outer_radius = p.inner_radius; }), "vessel.outer_radius");
  EXPECT_EQ(key_of([](Parameters& p) { p.horizon = 1.9e-4; }), "discretisation.horizon");
  EXPECT_EQ(key_of([](Parameters& p) { p.horizon = 9e-4; }), "discretisation.horizon");
  EXPECT_EQ(key_of([](Parameters& p) { p.particles = 1000; }), "discretisation.particles");
  EXPECT_EQ(key_of([](Parameters& p) { p.spacing.reset(); }), "discretisation.spacing");
  EXPECT_EQ(key_of([](Parameters& p) {
              p.spacing = 6e-4;
              p.horizon = 2e-3;
            }),
            "discretisation.spacing");
  EXPECT_EQ(key_of([](Parameters& p) { p.lattice_shift = {0.5}; }), "discretisation.lattice_shift");
  EXPECT_EQ(key_of([](Parameters& p) { p.schedule = Schedule::table; }), "load.table");
  EXPECT_EQ(key_of([](Parameters& p) { p.table = {{0, 0}, {1, 1}}; }), "load.table");
  EXPECT_EQ(key_of([](Parameters& p) {
              p.schedule = Schedule::table;
              p.table = {{0, 0}, {0, 1}};
            }),
            "load.table");
  EXPECT_EQ(key_of([](Parameters& p) {
              p.ends = EndCondition::axial_periodic;
              p.length = 6e-4;
            }),
            "vessel.length");
}

TEST(Parameters, ThinWallIsWarnedOf) {
  Parameters p = test::paper_vessel();
  EXPECT_TRUE(resolve(p).empty());
  p = test::paper_vessel();
  p.spacing = 2e-4;
  p.horizon = 7e-4;
  p.layer = LayerForce::consistent;
  EXPECT_EQ(resolve(p).size(), 1u);
}

TEST(Parameters, LoadThatFallsOutsideTheWallIsWarnedOf) {
  Parameters p = test::paper_vessel();
  p.layer_thickness = 6e-4;
  EXPECT_EQ(resolve(p).size(), 1u);
}

}  // namespace
}  // namespace rhexis::peridynamics
