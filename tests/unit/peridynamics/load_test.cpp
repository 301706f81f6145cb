// SPDX-License-Identifier: BSD-3-Clause
// Eq. (8)'s layer, schedules, the opening gauge and venting.
#include <gtest/gtest.h>

#include <numbers>

#include "core/error.hpp"
#include "peridynamics/loads/pressure_layer.hpp"
#include "peridynamics/loads/schedule.hpp"
#include "peridynamics/loads/venting.hpp"
#include "peridynamics/monitors/opening.hpp"
#include "support/vessels.hpp"

namespace rhexis::peridynamics {
namespace {

/// sum |b| V / (P 2 pi r0 L).
double relative_resultant(const Parameters& p) {
  const Lattice lattice = make_lattice(p);
  const PressureLayer layer = make_pressure_layer(p, lattice);
  double sum = 0;
  for (std::size_t c = 0; c < lattice.section.size(); ++c) {
    sum += std::hypot(layer.bx[c], layer.by[c]) * lattice.volume(c) * static_cast<double>(lattice.rows);
  }
  return sum / (2 * std::numbers::pi * p.inner_radius * p.length);
}

TEST(PressureLayer, ResultantIsExact) {
  for (const char* layer : {"consistent", "nonlocal"}) {
    for (const char* kind : {"lattice", "polar"}) {
      for (double thickness : {1e-4, 3.5e-4}) {
        Parameters p = test::paper_vessel();
        p.cross_section = value_of<Arrangement>(kind).value();
        p.layer = value_of<LayerForce>(layer).value();
        p.layer_thickness = thickness;
        resolve(p);
        EXPECT_NEAR(relative_resultant(p), 1, 1e-13) << layer << ' ' << kind << ' ' << thickness;
      }
    }
  }
}

TEST(PressureLayer, NonlocalLayerIsThePullOfTheBondsThatASurfaceCuts) {
  // Under uniform strain along its normal, bonds pull along it in proportion to m^3, m the cosine of their
  // angle to the normal: integrated over the part of a family that lies beyond the surface.
  const auto cut_pull = [](double depth) {  // in horizons
    constexpr int n = 2000;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const double r = depth + (1 - depth) * (i + 0.5) / n, least = depth / r;
      sum += r * r * (1 - least * least * least * least) / 4 * (1 - depth) / n;
    }
    return sum;
  };
  Parameters p = test::paper_vessel();
  p.cross_section = Arrangement::polar;
  p.layer = LayerForce::nonlocal;
  resolve(p);
  const Lattice lattice = make_lattice(p);
  const PressureLayer layer = make_pressure_layer(p, lattice);
  std::vector<double> ratios;
  for (std::size_t c = 0; c < lattice.section.size(); ++c) {
    const double depth =
        (std::hypot(lattice.section.x[c], lattice.section.y[c]) - p.inner_radius) / *p.layer_thickness;
    if (depth < 0.99) ratios.push_back(std::hypot(layer.bx[c], layer.by[c]) / cut_pull(depth));
  }
  for (double ratio : ratios) EXPECT_NEAR(ratio / ratios.front(), 1, 1e-3);
}

TEST(PressureLayer, PaperResultantIsTooLarge) {
  // Inside the wall Eq. (8) loads the area between r0 and r0 + delta: (1 + delta / (2 r0)) of the lumen's
  // surface.
  Parameters p = test::paper_vessel();
  p.cross_section = Arrangement::polar;
  p.spacing = 0.25e-4;  // fine rings, whose areas fill the layer exactly
  p.horizon = 1e-4;
  p.layer_thickness = 3.5e-4;
  resolve(p);
  EXPECT_NEAR(relative_resultant(p), 1 + 3.5e-4 / (2 * 1.5e-3), 1e-3);
}

TEST(PressureLayer, PointsOutwardsAndBalances) {
  Parameters p = test::paper_vessel();
  resolve(p);
  const Lattice lattice = make_lattice(p);
  const PressureLayer layer = make_pressure_layer(p, lattice);
  double fx = 0, fy = 0;
  for (std::size_t c = 0; c < lattice.section.size(); ++c) {
    const double outward = layer.bx[c] * lattice.section.x[c] + layer.by[c] * lattice.section.y[c];
    EXPECT_EQ(layer.loads(c), outward > 0);
    fx += layer.bx[c];
    fy += layer.by[c];
  }
  EXPECT_NEAR(fx, 0, 1e-8);
  EXPECT_NEAR(fy, 0, 1e-8);
}

TEST(Schedule, Shapes) {
  Parameters p = test::paper_vessel();
  p.pressure = 100;
  p.ramp_time = 2.0;
  resolve(p);
  p.schedule = Schedule::step;
  EXPECT_EQ(scheduled_pressure(p, 0), 100);
  p.schedule = Schedule::ramp;
  EXPECT_EQ(scheduled_pressure(p, 0), 0);
  EXPECT_EQ(scheduled_pressure(p, 0.5), 25);
  EXPECT_EQ(scheduled_pressure(p, 3), 100);
  p.schedule = Schedule::smooth_ramp;
  EXPECT_EQ(scheduled_pressure(p, 0), 0);
  EXPECT_NEAR(scheduled_pressure(p, 0.5), 100 * (1 - std::sqrt(0.5)) / 2, 1e-12);
  EXPECT_NEAR(scheduled_pressure(p, 1), 50, 1e-12);
  EXPECT_EQ(scheduled_pressure(p, 3), 100);
  p.schedule = Schedule::table;
  p.table = {{1, 10}, {2, 30}, {4, 0}};
  EXPECT_EQ(scheduled_pressure(p, 0), 10);
  EXPECT_EQ(scheduled_pressure(p, 1.5), 20);
  EXPECT_EQ(scheduled_pressure(p, 2), 30);
  EXPECT_EQ(scheduled_pressure(p, 3), 15);
  EXPECT_EQ(scheduled_pressure(p, 9), 0);
}

TEST(Schedule, StartsWhereItFirstHasAPressure) {
  Parameters p = test::paper_vessel();
  p.pressure = 100;
  p.ramp_time = 2.0;
  resolve(p);
  const auto starts_with = [&](const char* schedule, double pressure) {
    p.schedule = value_of<Schedule>(schedule).value();
    p.schedule_start = time_of_pressure(p, pressure);
    EXPECT_NEAR(scheduled_pressure(p, 0), pressure, 1e-10) << schedule;
    return p.schedule_start;
  };
  EXPECT_DOUBLE_EQ(starts_with("ramp", 25), 0.5);
  EXPECT_DOUBLE_EQ(scheduled_pressure(p, 0.5), 50) << "and goes on at its rate";
  EXPECT_DOUBLE_EQ(starts_with("smooth_ramp", 50), 1);
  p.table = {{1, 10}, {2, 30}, {3, 5}, {4, 60}};
  EXPECT_DOUBLE_EQ(starts_with("table", 10), 1);
  EXPECT_DOUBLE_EQ(starts_with("table", 20), 1.5);
  EXPECT_DOUBLE_EQ(starts_with("table", 49), 3.8);
  EXPECT_DOUBLE_EQ(starts_with("table", 5), 3) << "below its first pressure, as it falls";
  EXPECT_DOUBLE_EQ(starts_with("table", 7.5), 2.9);
  EXPECT_THROW(time_of_pressure(p, 4), InputError);
  EXPECT_THROW(time_of_pressure(p, 61), InputError);
  EXPECT_EQ(highest_pressure(p), 60);
  p.schedule = Schedule::ramp;
  EXPECT_THROW(time_of_pressure(p, 101), InputError);
  EXPECT_EQ(highest_pressure(p), 100);
  p.schedule = Schedule::step;
  EXPECT_EQ(time_of_pressure(p, 40), 0);
}

class Opening : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(CrossSections, Opening, testing::Values("lattice", "polar"));

TEST_P(Opening, IntactAndUniformlyWidenedWallsAreClosed) {
  Parameters p = test::paper_vessel();
  p.cross_section = value_of<Arrangement>(GetParam()).value();
  BodySetup setup = test::setup_of(p, 1e-7);
  const Lattice lattice = setup.lattice;
  const auto body = make_body(std::move(setup), test::self());
  const OpeningGauge gauge(lattice, *body, test::self(), p.ends);
  EXPECT_EQ(gauge.area(), 0);
  body->set_state(test::sample(*body,
                               [](auto x) {
                                 return std::array{0.3 * x[0], 0.3 * x[1], 0.0};
                               }),
                  test::sample(*body, test::nothing));
  EXPECT_EQ(gauge.area(), 0);
}

TEST(Opening, IntactWallsOfAnyFinenessAreClosed) {
  // Rings of 100 to 1200 columns: whatever the bins, the gaps of the reference state do not count.
  for (double spacing = 1e-4; spacing > 9e-6; spacing *= 0.87) {
    Parameters p = test::paper_vessel(3 * spacing);
    p.cross_section = Arrangement::polar;
    p.ends = EndCondition::free;
    p.outer_radius = p.inner_radius + 4 * spacing;
    p.spacing = spacing;
    p.horizon = 2.01 * spacing;
    BodySetup setup = test::setup_of(p, 1e-9);
    const Lattice lattice = setup.lattice;
    const auto body = make_body(std::move(setup), test::self());
    ASSERT_EQ(OpeningGauge(lattice, *body, test::self(), EndCondition::free).area(), 0)
        << lattice.section.size();
  }
}

TEST_P(Opening, KnownSlitIsMeasured) {
  // The wall is cut along the negative x axis over its middle third and bent open to a gap of known angle.
  Parameters p = test::paper_vessel(3e-3);
  p.cross_section = value_of<Arrangement>(GetParam()).value();
  BodySetup setup = test::setup_of(p, 1e-7);
  const Lattice lattice = setup.lattice;
  const auto body = make_body(std::move(setup), test::self());
  const OpeningGauge gauge(lattice, *body, test::self(), p.ends);
  const double mid_radius = 1.75e-3, slit_length = 1e-3;
  for (double half_angle : {0.1, 0.3, 0.6}) {
    const auto bent = [&](std::array<double, 3> x) -> std::array<double, 3> {
      if (x[2] < 1e-3 || x[2] > 2e-3) return {0, 0, 0};
      const double angle = std::atan2(x[1], x[0]), r = std::hypot(x[0], x[1]);
      const double turned = angle * (1 - half_angle / std::numbers::pi);
      return {r * std::cos(turned) - x[0], r * std::sin(turned) - x[1], 0};
    };
    body->set_state(test::sample(*body, bent), test::sample(*body, test::nothing));
    const double exact = 2 * half_angle * mid_radius * slit_length;
    // Known to about a spacing of width over the slit's rows.
    EXPECT_NEAR(gauge.area(), exact, 1.2 * lattice.spacing * slit_length) << half_angle;
  }
}

TEST_P(Opening, KnownTearAcrossTheAxisIsMeasured) {
  // Above its middle, all of the wall or the half of it at positive x is moved up.
  Parameters p = test::paper_vessel(3e-3);
  p.cross_section = value_of<Arrangement>(GetParam()).value();
  BodySetup setup = test::setup_of(p, 1e-7);
  const Lattice lattice = setup.lattice;
  const auto body = make_body(std::move(setup), test::self());
  const OpeningGauge gauge(lattice, *body, test::self(), p.ends);
  double mean_radius = 0;
  for (std::size_t c = 0; c < lattice.section.size(); ++c)
    mean_radius +=
        std::hypot(lattice.section.x[c], lattice.section.y[c]) / static_cast<double>(lattice.section.size());
  for (const double gap : {2e-4, 1e-3}) {
    for (const double share : {1.0, 0.5}) {
      const auto torn = [&](const std::array<double, 3>& x) -> std::array<double, 3> {
        const bool moves = x[2] > 1.5e-3 && (share == 1 || x[0] > 0);
        return {0, 0, moves ? gap : 0.0};
      };
      body->set_state(test::sample(*body, torn), test::sample(*body, test::nothing));
      const double exact = 2 * std::numbers::pi * mean_radius * share * gap;
      // Two sectors hold the edges of the half.
      EXPECT_NEAR(gauge.area(), exact, share == 1 ? 1e-9 * exact : 4 * lattice.spacing * gap) << gap;
    }
  }
}

TEST_P(Opening, TearAtTheSeamOfPeriodicEndsCountsAsAnyOther) {
  Parameters p = test::paper_vessel(3e-3);
  p.cross_section = value_of<Arrangement>(GetParam()).value();
  p.ends = EndCondition::axial_periodic;
  BodySetup setup = test::setup_of(p, 1e-7);
  const Lattice lattice = setup.lattice;
  const auto body = make_body(std::move(setup), test::self());
  const OpeningGauge gauge(lattice, *body, test::self(), p.ends);
  EXPECT_EQ(gauge.area(), 0);
  // Squeezed to half its length the piece gapes at the seam; the same towards the seam, in its middle.
  const auto area = [&](double towards) {
    const auto squeezed = [&](const std::array<double, 3>& x) -> std::array<double, 3> {
      return {0, 0, 0.5 * (towards - x[2]) + (x[2] < 1.5e-3 && towards > 2e-3 ? -1.5e-3 : 0.0)};
    };
    body->set_state(test::sample(*body, squeezed), test::sample(*body, test::nothing));
    return gauge.area();
  };
  const double at_seam = area(1.5e-3);
  EXPECT_GT(at_seam, 2 * std::numbers::pi * 1.5e-3 * 1.4e-3);
  EXPECT_NEAR(at_seam, area(3e-3), 1e-9 * at_seam);
}

TEST(Venting, ClosedForms) {
  EXPECT_EQ(venting_factor(0, 1e-6), 1);
  EXPECT_EQ(venting_factor(1e-6, 1e-6), 0.5);
  // 1 mm2 at 10 kPa of blood: 0.62 x 1e-6 x sqrt(2 x 1e4 / 1060) m3/s.
  EXPECT_NEAR(orifice_flow(0.62, 1e-6, 1e4, 1060), 2.693e-6, 1e-9);
  EXPECT_EQ(orifice_flow(0.62, 1e-6, -5, 1060), 0);
}

TEST(LumenGauge, ResistanceAndStretchOfAWidenedVessel) {
  for (const char* kind : {"lattice", "polar"}) {
    Parameters p = test::paper_vessel();
    p.cross_section = value_of<Arrangement>(kind).value();
    const BodySetup setup = test::setup_of(p, 1e-7);
    const Lattice lattice = setup.lattice;
    const auto body = make_body(setup, test::self());
    const LumenGauge gauge(lattice, *body, test::self());
    EXPECT_NEAR(gauge.resistance_factor(), 1, 1e-10) << kind;
    EXPECT_NEAR(gauge.largest_stretch(), 1, 1e-10) << kind;
    const double half = static_cast<double>(lattice.rows) * lattice.row_spacing / 2;
    // One half wider by a tenth, the other narrower by a fifth.
    const auto u = test::sample(*body, [&](const std::array<double, 3>& x) {
      const double widening = x[2] < half ? 0.1 : -0.2;
      return std::array<double, 3>{widening * x[0], widening * x[1], 0};
    });
    const auto rest =
        test::sample(*body, [](const std::array<double, 3>&) { return std::array<double, 3>{}; });
    body->set_state(u, rest);
    EXPECT_NEAR(gauge.resistance_factor(), (std::pow(1.1, -4) + std::pow(0.8, -4)) / 2, 1e-9) << kind;
    EXPECT_NEAR(gauge.largest_stretch(), 1.1, 1e-10) << kind;
  }
}

TEST(AxialProfile, ScalesTheLoadRowByRow) {
  Parameters p = test::paper_vessel();
  p.ends = EndCondition::free;
  const BodySetup setup = test::setup_of(p, 1e-7);
  const auto body = make_body(setup, test::self());
  const auto rows = static_cast<std::size_t>(setup.lattice.rows);
  const auto uniform = body->observe(1000).force_density;
  std::vector<double> profile(rows);
  for (std::size_t r = 0; r < rows; ++r) profile[r] = static_cast<double>(r) / static_cast<double>(rows);
  body->set_axial_profile(
      [&](double z) { return profile[static_cast<std::size_t>(z / setup.lattice.row_spacing)]; });
  const auto& sloped = body->observe(1000).force_density;
  for (std::size_t i = 0; i < uniform[0].size(); ++i) {
    for (int k = 0; k < 2; ++k) EXPECT_EQ(sloped[k][i], profile[i % rows] * uniform[k][i]) << i;
  }
}

}  // namespace
}  // namespace rhexis::peridynamics
