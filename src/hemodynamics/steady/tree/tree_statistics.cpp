// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/tree/tree_statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "hemodynamics/steady/tree/bin_finder.hpp"
#include "hemodynamics/steady/tree/lanes.hpp"
#include "network/wall.hpp"
#include "parallel/exact_sum.hpp"
#include "parallel/threads.hpp"

namespace rhexis::hemodynamics {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using lanes::Real;
using lanes::Reals;
using lanes::width;
using parallel::ExactSum;
using Integers = BinFinder::Integers;

/// Copies of every counter, taken by turns, so that equal bins do not wait for each other.
constexpr int copies_shift = 1;
constexpr std::size_t copies = std::size_t{1} << copies_shift;

/// Sum, least and most of one quantity in one generation.
struct Tally {
  explicit Tally(double scale) : sum(scale) {}
  ExactSum sum;
  double least = std::numeric_limits<double>::infinity(), most = -least;

  void add(const Tally& other) {
    sum.add(other.sum);
    least = std::min(least, other.least);
    most = std::max(most, other.most);
  }

  Spread spread(double count, parallel::Communicator comm) const {
    return {sum.value(comm) / count, comm.all_reduce(least, parallel::Reduce::min),
            comm.all_reduce(most, parallel::Reduce::max)};
  }
};

/// The same, lane by lane, of blocks since the last pause.
struct LaneTally {
  Real total, low, high;
  LaneTally() {
    const Reals d;
    total = hn::Zero(d);
    low = hn::Set(d, std::numeric_limits<double>::infinity());
    high = hn::Neg(low);
  }
  HWY_INLINE void add(Real v, hn::Mask<Reals> counted) {
    total = hn::Add(total, hn::IfThenElseZero(counted, v));
    low = hn::Min(low, v);
    high = hn::Max(high, v);
  }
  void leave(Tally& tally, double weight) {
    const Reals d;
    tally.sum.add(hn::GetLane(hn::SumOfLanes(d, total)) * weight);
    tally.least = std::min(tally.least, hn::GetLane(hn::MinOfLanes(d, low)));
    tally.most = std::max(tally.most, hn::GetLane(hn::MaxOfLanes(d, high)));
    *this = LaneTally();
  }
};

enum Quantity : std::size_t {
  radius,
  length,
  flow,
  square_length,
  radius_length,
  pressure,
  vein_pressure,
  stress,
  vein_stress,
  quantities
};
/// Counting takes most of a sweep's time, so what belongs together is counted at once: flow; pressure of
/// artery and vein, in a table of both; hoop stress of both. What is reported are the tables' sums over rows
/// and columns.
constexpr std::size_t tables = 3;
constexpr int flow_shift = 8, pressure_shift = 6, stress_shift = 6;  ///< bins: powers of two
constexpr std::size_t counters[tables] = {copies << flow_shift, copies << (2 * pressure_shift),
                                          copies << (2 * stress_shift)};

/// What all generations and threads share.
struct Context {
  Bins pressure_bins, flow_bins, stress_bins;
  double vein_ratio = 1;
  bool stress_by_radius[2]{};
  double stress_factor[2]{};                          ///< where it does not depend on the radius
  network::IntervalTable stress_table[2];             ///< hoop stress by the artery's radius, artery and vein
  double narrow_radius[2]{};                          ///< artery's radius below which the table ends
  std::vector<std::array<double, quantities>> scale;  ///< scale of the sums, by generation
};

struct GenerationGatherer {
  GenerationGatherer(const Context& c, int generation) {
    for (std::size_t table = 0; table < tables; ++table) counts[table].resize(counters[table]);
    for (const double scale : c.scale[static_cast<std::size_t>(generation)]) tallies.emplace_back(scale);
  }

  void add(const GenerationGatherer& other) {
    for (std::size_t q = 0; q < quantities; ++q) tallies[q].add(other.tallies[q]);
    for (std::size_t kind = 0; kind < 2; ++kind) narrow[kind] += other.narrow[kind];
    for (std::size_t table = 0; table < tables; ++table) {
      for (std::size_t i = 0; i < counters[table]; ++i) counts[table][i] += other.counts[table][i];
    }
  }

  std::vector<std::uint64_t> flow_counts() const { return sums(0, copies_shift, flow_shift); }
  /// Over the other kind's bins; kind 0: arteries (rows), 1: veins (columns).
  std::vector<std::uint64_t> pressure_counts(std::size_t kind) const {
    return sums(1, copies_shift + (kind == 0 ? pressure_shift : 0), pressure_shift);
  }
  std::vector<std::uint64_t> stress_counts(std::size_t kind) const {
    return sums(2, copies_shift + (kind == 0 ? stress_shift : 0), stress_shift);
  }

  /// Sums of a table's counters that agree in `bits` bits of their index from bit `shift` on.
  std::vector<std::uint64_t> sums(std::size_t table, int shift, int bits) const {
    std::vector<std::uint64_t> total(std::size_t{1} << bits);
    for (std::size_t i = 0; i < counters[table]; ++i)
      total[i >> shift & (total.size() - 1)] += counts[table][i];
    return total;
  }

  void leave(double weight) {
    for (std::size_t q = 0; q < quantities; ++q) lanes[q].leave(tallies[q], weight);
  }

  std::vector<Tally> tallies;
  std::array<LaneTally, quantities> lanes;
  std::array<std::vector<std::uint64_t>, tables> counts;
  double narrow[2]{};
};

class Gatherer : public VesselConsumer {
 public:
  Gatherer(const Context& context, int generations, VesselConsumer* also)
      : c_(context),
        also_(also),
        find_flow_(context.flow_bins),
        find_pressure_(context.pressure_bins),
        find_stress_(context.stress_bins) {
    for (int g = 0; g < generations; ++g) generations_.emplace_back(context, g);
  }

  void consume(const VesselBlock& b) override {
    if (also_ != nullptr) also_->consume(b);
    if (b.count >= width) {
      gather(b);
      return;
    }
    // Filled up with the first vessel, which then does not count again.
    const double* const arrays[] = {b.radius,     b.length,    b.flow,    b.artery_near,
                                    b.artery_far, b.vein_near, b.vein_far};
    double filled[7][width];
    for (std::size_t a = 0; a < 7; ++a) {
      std::fill_n(filled[a], width, arrays[a][0]);
      std::copy_n(arrays[a], b.count, filled[a]);
    }
    VesselBlock full = b;
    full.count = width;
    full.radius = filled[0];
    full.length = filled[1];
    full.flow = filled[2];
    full.artery_near = filled[3];
    full.artery_far = filled[4];
    full.vein_near = filled[5];
    full.vein_far = filled[6];
    gather(full, b.count);
  }

  void pause() override {
    for (GenerationGatherer& g : generations_) g.leave(1);
  }

  const std::vector<GenerationGatherer>& generations() const { return generations_; }

 private:
  HWY_INLINE Real stress_of(int kind, Real r, Real p) const {
    if (!c_.stress_by_radius[kind]) return hn::Mul(p, hn::Set(Reals(), c_.stress_factor[kind]));
    return hn::Mul(p, lanes::value_of(c_.stress_table[kind], r));
  }

  /// `counted`: vessels of every vector that count.
  void gather(const VesselBlock& b, std::size_t counted = width) {
    const Reals d;
    const Integers di;
    GenerationGatherer& g = generations_[static_cast<std::size_t>(b.generation)];
    std::array<LaneTally, quantities> t = g.lanes;
    const auto weight = static_cast<std::uint64_t>(b.multiplicity);
    const auto valid = hn::FirstN(d, counted);
    const auto half = hn::Set(d, 0.5);
    const auto narrow_artery = hn::Set(d, c_.narrow_radius[0]), narrow_vein = hn::Set(d, c_.narrow_radius[1]);
    std::size_t narrow[2] = {};
    alignas(64) std::int64_t place[tables][width];
    const auto turn = hn::And(hn::Iota(di, 0), hn::Set(di, static_cast<std::int64_t>(copies) - 1));
    for (std::size_t i = 0; i < b.count; i += width) {
      const Real r = hn::LoadU(d, b.radius + i), l = hn::LoadU(d, b.length + i), q = hn::LoadU(d, b.flow + i);
      const Real p = hn::Mul(half, hn::Add(hn::LoadU(d, b.artery_near + i), hn::LoadU(d, b.artery_far + i)));
      const Real v = hn::Mul(half, hn::Add(hn::LoadU(d, b.vein_near + i), hn::LoadU(d, b.vein_far + i)));
      const Real rl = hn::Mul(r, l), s = stress_of(0, r, p), w = stress_of(1, r, v);
      const Real values[quantities] = {r, l, q, hn::Mul(r, rl), rl, p, v, s, w};
      for (std::size_t k = 0; k < quantities; ++k) t[k].add(values[k], valid);
      narrow[0] += hn::CountTrue(d, hn::And(valid, hn::Lt(r, narrow_artery)));
      narrow[1] += hn::CountTrue(d, hn::And(valid, hn::Lt(r, narrow_vein)));
      const auto both = [&](auto shift, auto artery, auto vein) {
        return hn::Or(hn::ShiftLeft<copies_shift>(hn::Or(hn::ShiftLeft<shift.value>(artery), vein)), turn);
      };
      hn::Store(hn::Or(hn::ShiftLeft<copies_shift>(find_flow_(hn::Abs(q))), turn), di, place[0]);
      hn::Store(both(std::integral_constant<int, pressure_shift>(), find_pressure_(p), find_pressure_(v)), di,
                place[1]);
      hn::Store(both(std::integral_constant<int, stress_shift>(), find_stress_(s), find_stress_(w)), di,
                place[2]);
      for (std::size_t table = 0; table < tables; ++table) {
        std::uint64_t* const counts = g.counts[table].data();
        for (std::size_t k = 0; k < counted; ++k) counts[place[table][k]] += weight;
      }
    }
    g.lanes = t;
    for (std::size_t kind = 0; kind < 2; ++kind)
      g.narrow[kind] += static_cast<double>(narrow[kind]) * b.multiplicity;
    if (b.multiplicity != 1) g.leave(b.multiplicity);
  }

  const Context& c_;
  VesselConsumer* also_;
  BinFinder find_flow_, find_pressure_, find_stress_;
  std::vector<GenerationGatherer> generations_;
};

/// The longest that a vessel of a generation can be, over its radius.
double longest_ratio(const network::TreeRules& rules, int generation, double narrowest) {
  const auto ratio = [&](double radius) { return rules.length(generation, radius) / radius; };
  double longest = std::max(ratio(narrowest), ratio(rules.root_radius));
  for (const auto& [radius, length] : rules.length_by_radius)
    if (radius > narrowest && radius < rules.root_radius) longest = std::max(longest, length / radius);
  return longest * (1 + rules.length_spread);
}

/// Bounds for the sums over a generation (`top` and `stress`: of a vessel's pressure and hoop stress), so
/// that the whole of it fits even in one term.
std::array<double, quantities> scales(const network::TreeRules& rules, int generation, double narrowest,
                                      double inflow, double top, double stress) {
  // Sum of r^p: of r^xi it is the root's. Below that power the sum is greatest where all vessels are alike;
  // above, one of them could have it all.
  const auto powers = [&](int p) {
    return std::pow(rules.root_radius, p) * std::exp2(generation * std::max(0.0, 1 - p / rules.exponent));
  };
  const double ratio = longest_ratio(rules, generation, narrowest);
  const double many = std::ldexp(1.0, generation);
  return {powers(1),  ratio * powers(1), inflow,        ratio * powers(3), ratio * powers(2),
          top * many, top * many,        stress * many, stress * many};
}

Context make_context(const TreeFlow& flow, const Viscosity& viscosity) {
  const network::TreeRules& rules = flow.tree().rules();
  Context c;
  const double least = std::min(flow.inlet_pressure(), flow.outlet_pressure());
  const double most = std::max(flow.inlet_pressure(), flow.outlet_pressure());
  c.pressure_bins = {false, std::size_t{1} << pressure_shift, least, most > least ? most : least + 1};
  c.flow_bins = {true, std::size_t{1} << flow_shift, 0, std::abs(flow.flow())};
  c.vein_ratio = rules.vein_radius_ratio;
  const double widest = rules.root_radius;
  const double narrowest = flow.tree().radius_of(flow.tree().least_capacity()) * (1 - 1e-6);
  double largest_factor = 0;
  for (int kind = 0; kind < 2; ++kind) {
    const network::Wall& wall = kind == 0 ? rules.artery_wall : rules.vein_wall;
    const double ratio = kind == 0 ? 1 : c.vein_ratio;
    const auto factor = [=](long double r) {
      return network::lumen_stress_factor(wall.relative_thickness(r * static_cast<long double>(ratio)));
    };
    c.stress_by_radius[kind] = wall.rule == network::WallRule::radius;
    c.stress_factor[kind] = static_cast<double>(factor(widest));
    if (c.stress_by_radius[kind])
      c.stress_table[kind] = network::IntervalTable(factor, narrowest, widest * (1 + 1e-6));
    largest_factor = std::max(
        {largest_factor, static_cast<double>(factor(widest)), static_cast<double>(factor(narrowest))});
    c.narrow_radius[kind] =
        viscosity.law == ViscosityLaw::constant ? 0 : viscosity.least_radius() / ratio;
  }
  const double top = std::max(std::abs(least), std::abs(most));
  c.stress_bins = {true, std::size_t{1} << stress_shift, 0, top * largest_factor};
  for (int generation = 0; generation < rules.generations; ++generation)
    c.scale.push_back(scales(rules, generation, narrowest, std::abs(flow.flow()), top, c.stress_bins.high));
  return c;
}

/// Over all ranks.
std::vector<std::uint64_t> of_all(std::vector<std::uint64_t> counts, parallel::Communicator comm) {
  comm.all_reduce(counts, parallel::Reduce::sum);
  return counts;
}

}  // namespace

TreeStatistics gather_statistics(const TreeFlow& flow, const Viscosity& viscosity,
                                 parallel::Communicator comm,
                                 const std::function<VesselConsumer&(int thread)>& also) {
  const int k = flow.tree().generations();
  const Context context = make_context(flow, viscosity);
  std::vector<std::unique_ptr<Gatherer>> gatherers;
  for (int t = 0; t < parallel::thread_count(); ++t)
    gatherers.push_back(std::make_unique<Gatherer>(context, k, also ? &also(t) : nullptr));
  flow.sweep([&](int thread) -> VesselConsumer& { return *gatherers[static_cast<std::size_t>(thread)]; });

  TreeStatistics s;
  s.pressure_bins = context.pressure_bins;
  s.flow_bins = context.flow_bins;
  s.stress_bins = context.stress_bins;
  const double ratio = context.vein_ratio;
  for (int generation = 0; generation < k; ++generation) {
    const auto at = static_cast<std::size_t>(generation);
    GenerationGatherer total(context, generation);
    for (const auto& gatherer : gatherers) total.add(gatherer->generations()[at]);
    GenerationStatistics g;
    g.generation = generation;
    g.vessels = std::ldexp(1.0, generation);
    const auto spread = [&](Quantity q) { return total.tallies[q].spread(g.vessels, comm); };
    const auto sum = [&](Quantity q) { return total.tallies[q].sum.value(comm); };
    g.radius[0] = spread(radius);
    g.radius[1] = {g.radius[0].mean * ratio, g.radius[0].least * ratio, g.radius[0].most * ratio};
    g.mean_length = sum(length) / g.vessels;
    g.flow = spread(Quantity::flow);
    g.volume[0] = std::numbers::pi * sum(square_length);
    g.volume[1] = g.volume[0] * ratio * ratio;
    g.surface[0] = 2 * std::numbers::pi * sum(radius_length);
    g.surface[1] = g.surface[0] * ratio;
    g.pressure = {spread(pressure), spread(vein_pressure)};
    g.hoop_stress = {spread(stress), spread(vein_stress)};
    g.flow_counts = of_all(total.flow_counts(), comm);
    for (std::size_t kind = 0; kind < 2; ++kind) {
      g.pressure_counts[kind] = of_all(total.pressure_counts(kind), comm);
      g.stress_counts[kind] = of_all(total.stress_counts(kind), comm);
      s.narrow_vessels += comm.all_reduce(total.narrow[kind], parallel::Reduce::sum);
    }
    s.volume += g.volume[0] + g.volume[1];
    s.surface += g.surface[0] + g.surface[1];
    s.generations.push_back(std::move(g));
  }
  return s;
}

}  // namespace rhexis::hemodynamics
