// SPDX-License-Identifier: BSD-3-Clause
// Bond evaluations a second of Body::advance, one property of the wall changed at a time.
//
// Counters: directed bonds/s (two a bond) and the flop/s counted for them (peridynamics::flop_per_bond,
// whatever the law),
// ns a particle and step, and shares of two limits of this machine at that moment:
// - of_peak: of its fused multiply-adds. The kernel cannot reach 1: most of its operations are not fused.
// - of_arithmetic: of what it can do of a bond's own arithmetic (bond_arithmetic.hpp). Of uniform PMB walls.
#include <omp.h>

#include <functional>
#include <random>
#include <set>

#include "bench/bond_arithmetic.hpp"
#include "bench/cases.hpp"
#include "peridynamics/engine/bond_kernel.hpp"
#include "support/vessels.hpp"

namespace rhexis::bench {
namespace {

constexpr double flop_per_directed_bond = peridynamics::flop_per_bond / 2;

struct Wall {
  std::string section = "lattice";
  int across = 5;  ///< spacings
  int rows = 104;
  std::string bonds = "single", law = "pmb";
  bool scattered = false;
  std::string damage = "none";  ///< "scattered": of bonds; "cracked": of a column's bonds along all its rows
  double broken = 0;            ///< share of the bonds

  std::string name() const {
    return "bonds/section=" + section + "/across=" + std::to_string(across) +
           "/rows=" + std::to_string(rows) + "/bonds=" + bonds + "/law=" + law +
           "/wall=" + (scattered ? "scattered" : "uniform") + "/damage=" + damage +
           (broken > 0 ? std::to_string(std::lround(100 * broken)) : "");
  }
};

std::unique_ptr<peridynamics::Body> make_body(const Wall& wall) {
  peridynamics::Parameters p = test::paper_vessel();
  p.cross_section = value_of<peridynamics::Arrangement>(wall.section).value();
  p.surface_correction = peridynamics::SurfaceCorrection::none;  // changes numbers, not work
  p.spacing = (p.outer_radius - p.inner_radius) / wall.across;
  p.horizon = 3.5 * *p.spacing;
  p.length = wall.rows * *p.spacing;
  p.bond_precision = value_of<Precision>(wall.bonds).value();
  p.law.name = wall.law;
  if (wall.law == "fung") p.law.numbers["fung_exponent"] = 5;
  if (wall.scattered) p.scatter.critical_stretch = p.scatter.stiffness = 0.03;
  peridynamics::BodySetup setup = test::setup_of(p, 1e-9);
  setup.time_step = 0.5 * test::stable_step_of(setup);
  return peridynamics::make_body(std::move(setup), test::self());
}

/// Inflated by 1 %, so that forces are ordinary numbers, and damaged.
void set_state(peridynamics::Body& body, const Wall& wall) {
  const auto inflated = [](const std::array<double, 3>& x) {
    return std::array<double, 3>{0.01 * x[0], 0.01 * x[1], 0};
  };
  body.set_state(test::sample(body, inflated), test::sample(body, test::nothing));
  if (wall.broken == 0) return;
  peridynamics::Body::Saved state = body.save();
  const TablePart table = body.word_table();
  std::mt19937_64 random(1);
  std::bernoulli_distribution breaks(wall.broken);
  auto word = state.words.begin();
  for (std::int64_t bond = 0; bond < table.rows.local_count(); ++bond) {
    const bool all = wall.damage == "cracked" && breaks(random);
    for (std::int64_t i = 0; i < table.count; ++i, ++word) {
      if (all) *word = 0;
      for (int bit = 0; wall.damage == "scattered" && bit < 16; ++bit) {
        if (breaks(random)) *word = static_cast<std::uint16_t>(*word & ~(1u << bit));
      }
    }
  }
  body.restore(state);
}

void run(benchmark::State& state, const Wall& wall, int threads) {
  omp_set_num_threads(threads);
  const auto body = make_body(wall);
  set_state(*body, wall);
  std::int64_t evaluated = 0;
  const auto advance = [&](int steps) {
    body->advance(0, 0);  // wakes threads and caches after the measurement of the peak
    const std::int64_t before = body->bond_evaluations();
    const double start = now(threads);
    for (int i = 0; i < steps; ++i) body->advance(0, 0);
    const double seconds = now(threads) - start;
    evaluated = body->bond_evaluations() - before;
    return Sample{seconds, flop_per_directed_bond * static_cast<double>(evaluated)};
  };
  constexpr double least_seconds = 20e-3;
  const int steps = 1 + static_cast<int>(least_seconds / advance(1).seconds);
  const bool single = wall.bonds == "single";
  const auto peak = [&] { return single ? fma_rate<float>(threads) : fma_rate<double>(threads); };
  const Medians found = measure(state, peak, [&] { return advance(steps); });
  const auto particles = static_cast<double>(body->ids().local_count());
  state.counters["bonds_per_s"] = found.rate / flop_per_directed_bond;
  state.counters["flop_per_s"] = found.rate;
  state.counters["ns_per_particle_step"] = 1e9 * found.seconds / (particles * steps);
  state.counters["particles"] = particles;
  state.counters["bonds_a_particle"] = static_cast<double>(evaluated) / (particles * steps);
  if (wall.law == "pmb" && !wall.scattered && wall.broken == 0) {
    std::vector<double> limits;  // of of_peak
    for (int i = 0; i < 5; ++i) {
      const double bonds =
          single ? bond_arithmetic_rate<float>(threads) : bond_arithmetic_rate<double>(threads);
      limits.push_back(bonds * peridynamics::flop_per_bond / peak());
    }
    state.counters["of_arithmetic"] = found.of_peak / median(limits);
  }
}

/// `wall` with something changed.
Wall with(Wall wall, const std::function<void(Wall&)>& change) {
  change(wall);
  return wall;
}

}  // namespace

void add_cases(const Options& options) {
  const Wall paper;
  std::vector<Wall> walls{paper};
  for (const int rows : {16, 100, 1000}) walls.push_back(with(paper, [&](Wall& w) { w.rows = rows; }));
  for (const int across : {3, 5, 10}) {
    walls.push_back(with(paper, [&](Wall& w) { w.section = "polar", w.across = across; }));
  }
  walls.push_back(with(paper, [](Wall& w) { w.bonds = "double"; }));
  for (const char* law : {"fung", "lps"}) walls.push_back(with(paper, [&](Wall& w) { w.law = law; }));
  walls.push_back(with(paper, [](Wall& w) { w.scattered = true; }));
  for (const char* damage : {"scattered", "cracked"}) {
    for (const double broken : {0.25, 0.75}) {
      walls.push_back(with(paper, [&](Wall& w) { w.damage = damage, w.broken = broken; }));
    }
  }
  for (const Wall& wall : walls) {
    for (const int threads : std::set{1, omp_get_num_procs()}) {
      add_case(wall.name() + "/threads=" + std::to_string(threads), options.samples,
               [=](benchmark::State& state) { run(state, wall, threads); });
    }
  }
}

}  // namespace rhexis::bench
