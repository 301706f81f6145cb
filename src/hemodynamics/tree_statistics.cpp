#include "hemodynamics/tree_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "hemodynamics/lanes.hpp"
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

constexpr int geometric_shift = 50;  ///< leaves two bits of the mantissa: four bins to an octave
constexpr std::size_t copies =
    4;  ///< of every bin, taken by turns, so that equal bins do not wait for each other

std::uint64_t quarter_octave(double value) {
  return std::bit_cast<std::uint64_t>(value) >> geometric_shift;
}
double quarter_edge(std::uint64_t quarter) {
  return std::bit_cast<double>(quarter << geometric_shift);
}

/// Counts of one quantity in one generation.
class Histogram {
 public:
  Histogram(const Bins& bins) : bins_(bins), counts_(bins.count * copies) {}

  void add(const double* values, std::size_t count, std::uint64_t weight) {
    alignas(64) std::int64_t index[width];
    const Reals d;
    const hn::RebindToSigned<Reals> di;
    const auto last = hn::Set(di, static_cast<std::int64_t>(bins_.count) - 1);
    const double per_bin = static_cast<double>(bins_.count) / (bins_.high - bins_.low);
    const auto top = hn::Set(di, static_cast<std::int64_t>(quarter_octave(bins_.high)));
    std::size_t i = 0;
    for (; i + width <= count; i += width) {
      const Real v = hn::LoadU(d, values + i);
      const auto bin =
          bins_.geometric
              ? hn::Sub(top, hn::ShiftRight<geometric_shift>(hn::BitCast(di, v)))
              : hn::ConvertTo(di, hn::Mul(hn::Sub(v, hn::Set(d, bins_.low)), hn::Set(d, per_bin)));
      hn::Store(hn::Min(hn::Max(bin, hn::Zero(di)), last), di, index);
      for (std::size_t k = 0; k < width; ++k) {
        counts_[static_cast<std::size_t>(index[k]) * copies + k % copies] += weight;
      }
    }
    for (; i < count; ++i) {
      const std::int64_t bin = bins_.geometric ? static_cast<std::int64_t>(quarter_octave(bins_.high)) -
                                                     static_cast<std::int64_t>(quarter_octave(values[i]))
                                               : static_cast<std::int64_t>((values[i] - bins_.low) * per_bin);
      const std::int64_t inside =
          std::clamp<std::int64_t>(bin, 0, static_cast<std::int64_t>(bins_.count) - 1);
      counts_[static_cast<std::size_t>(inside) * copies] += weight;
    }
  }

  void add_to(std::vector<std::uint64_t>& total) const {
    total.resize(bins_.count);
    for (std::size_t i = 0; i < counts_.size(); ++i) total[i / copies] += counts_[i];
  }

 private:
  Bins bins_;
  std::vector<std::uint64_t> counts_;
};

/// Sum, least and most of one quantity in one generation.
struct Tally {
  explicit Tally(double scale) : sum(scale) {}
  ExactSum sum;
  double least = std::numeric_limits<double>::infinity(), most = -least;

  void add(const double* values, std::size_t count, double weight) {
    const Reals d;
    Real total = hn::Zero(d), low = hn::Set(d, least), high = hn::Set(d, most);
    std::size_t i = 0;
    for (; i + width <= count; i += width) {
      const Real v = hn::LoadU(d, values + i);
      total = hn::Add(total, v);
      low = hn::Min(low, v);
      high = hn::Max(high, v);
    }
    double rest = hn::GetLane(hn::SumOfLanes(d, total));
    least = hn::GetLane(hn::MinOfLanes(d, low));
    most = hn::GetLane(hn::MaxOfLanes(d, high));
    for (; i < count; ++i) {
      rest += values[i];
      least = std::min(least, values[i]);
      most = std::max(most, values[i]);
    }
    sum.add(rest * weight);
  }

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

/// What all generations and threads share.
struct Context {
  Bins pressure, flow, stress;
  double vein_ratio = 1;
  bool stress_by_radius[2]{};
  double stress_factor[2]{};      ///< where it does not depend on the radius
  IntervalTable stress_table[2];  ///< of the artery's radius
  double narrow_radius[2]{};      ///< of the artery
  double radius_scale = 1, flow_scale = 1, pressure_scale = 1, stress_scale = 1, length_scale = 1;
};

/// Scale of sums that grow with the number of vessels, so that a whole generation fits one term of an
/// ExactSum.
double many_in(int generation) {
  return std::ldexp(1.0, std::max(0, generation - 20));
}

struct GenerationGatherer {
  GenerationGatherer(const Context& c, double many)
      : radius(c.radius_scale * many),
        length(c.length_scale * many),
        flow(c.flow_scale),
        volume(c.radius_scale * c.radius_scale * c.length_scale),
        surface(c.radius_scale * c.length_scale),
        pressure{Tally(c.pressure_scale * many), Tally(c.pressure_scale * many)},
        stress{Tally(c.stress_scale * many), Tally(c.stress_scale * many)},
        flow_counts(c.flow),
        pressure_counts{Histogram(c.pressure), Histogram(c.pressure)},
        stress_counts{Histogram(c.stress), Histogram(c.stress)} {}

  void add(const GenerationGatherer& other) {
    radius.add(other.radius);
    length.add(other.length);
    flow.add(other.flow);
    volume.add(other.volume);
    surface.add(other.surface);
    for (std::size_t kind = 0; kind < 2; ++kind) {
      pressure[kind].add(other.pressure[kind]);
      stress[kind].add(other.stress[kind]);
      narrow[kind] += other.narrow[kind];
    }
  }

  Tally radius, length, flow, volume, surface;  ///< volume and surface: sums of r^2 L and r L of arteries
  Tally pressure[2], stress[2];
  Histogram flow_counts, pressure_counts[2], stress_counts[2];
  double narrow[2]{};
};

class Gatherer : public VesselConsumer {
 public:
  Gatherer(const Context& context, int generations) : context_(context) {
    for (int g = 0; g < generations; ++g) generations_.emplace_back(context, many_in(g));
  }

  void consume(const VesselBlock& b) override {
    if (scratch_[0].size() < b.count + width) {
      for (auto& s : scratch_) s.resize(b.count + width);
    }
    GenerationGatherer& g = generations_[static_cast<std::size_t>(b.generation)];
    const auto weight = static_cast<std::uint64_t>(b.multiplicity);
    g.radius.add(b.radius, b.count, b.multiplicity);
    g.length.add(b.length, b.count, b.multiplicity);
    g.flow.add(b.flow, b.count, b.multiplicity);
    g.flow_counts.add(b.flow, b.count, weight);
    measure_geometry(b);
    g.volume.add(scratch_[0].data(), b.count, b.multiplicity);
    g.surface.add(scratch_[1].data(), b.count, b.multiplicity);
    for (int kind = 0; kind < 2; ++kind) {
      const auto at = static_cast<std::size_t>(kind);
      g.narrow[at] += measure_pressure(b, kind) * b.multiplicity;
      g.pressure[at].add(scratch_[0].data(), b.count, b.multiplicity);
      g.stress[at].add(scratch_[1].data(), b.count, b.multiplicity);
      g.pressure_counts[at].add(scratch_[0].data(), b.count, weight);
      g.stress_counts[at].add(scratch_[1].data(), b.count, weight);
    }
  }

  const std::vector<GenerationGatherer>& generations() const { return generations_; }

 private:
  /// r^2 L and r L.
  void measure_geometry(const VesselBlock& b) {
    for (std::size_t i = 0; i < b.count; ++i) {
      scratch_[1][i] = b.radius[i] * b.length[i];
      scratch_[0][i] = b.radius[i] * scratch_[1][i];
    }
  }

  /// Mean pressure and hoop stress; returns how many vessels are narrow.
  double measure_pressure(const VesselBlock& b, int kind) {
    const double *near = kind == 0 ? b.artery_near : b.vein_near,
                 *far = kind == 0 ? b.artery_far : b.vein_far;
    double *pressure = scratch_[0].data(), *stress = scratch_[1].data();
    const bool by_radius = context_.stress_by_radius[kind];
    const double factor = context_.stress_factor[kind], narrow_radius = context_.narrow_radius[kind];
    std::size_t narrow = 0;
    for (std::size_t i = 0; i < b.count; ++i) {
      pressure[i] = 0.5 * (near[i] + far[i]);
      stress[i] = pressure[i] * factor;
      narrow += b.radius[i] < narrow_radius;
    }
    if (!by_radius) return static_cast<double>(narrow);
    const IntervalTable& table = context_.stress_table[kind];
    const Reals d;
    std::size_t i = 0;
    for (; i + width <= b.count; i += width) {
      const Real k = lanes::value_of(table, hn::LoadU(d, b.radius + i));
      hn::StoreU(hn::Mul(k, hn::LoadU(d, pressure + i)), d, stress + i);
    }
    for (; i < b.count; ++i) stress[i] = table(b.radius[i]) * pressure[i];
    return static_cast<double>(narrow);
  }

  const Context& context_;
  std::vector<GenerationGatherer> generations_;
  std::vector<double> scratch_[2];
};

Context make_context(const TreeFlow& flow, const Viscosity& viscosity) {
  const network::TreeRules& rules = flow.tree().rules();
  Context c;
  const double least = std::min(flow.inlet_pressure(), flow.outlet_pressure());
  const double most = std::max(flow.inlet_pressure(), flow.outlet_pressure());
  c.pressure = {false, 64, least, most > least ? most : least + 1};
  c.flow = {true, 256, 0, std::abs(flow.flow())};
  c.vein_ratio = rules.vein_radius_ratio;
  const double widest = rules.root_radius;
  const double narrowest =
      flow.tree().radius_of(std::pow(1 - rules.wider_share(rules.least_asymmetry), rules.generations - 1)) *
      (1 - 1e-6);
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
      c.stress_table[kind] = IntervalTable(factor, narrowest, widest * (1 + 1e-6));
    largest_factor = std::max(
        {largest_factor, static_cast<double>(factor(widest)), static_cast<double>(factor(narrowest))});
    c.narrow_radius[kind] =
        viscosity.law == ViscosityLaw::constant ? 0 : viscosity.least_diameter / 2 / ratio;
  }
  const double top = std::max(std::abs(least), std::abs(most));
  c.stress = {true, 128, 0, top * largest_factor};
  c.radius_scale = widest;
  c.length_scale = rules.length(0, widest);
  c.flow_scale = std::abs(flow.flow());
  c.pressure_scale = top;
  c.stress_scale = c.stress.high;
  return c;
}

void add_counts(std::vector<std::uint64_t>& counts, parallel::Communicator comm) {
  comm.all_reduce(counts, parallel::Reduce::sum);
}

}  // namespace

double Bins::lower_edge(std::size_t bin) const {
  if (geometric) return quarter_edge(quarter_octave(high) - bin);
  return low + (high - low) * static_cast<double>(bin) / static_cast<double>(count);
}

double Bins::upper_edge(std::size_t bin) const {
  if (geometric) return quarter_edge(quarter_octave(high) - bin + 1);
  return lower_edge(bin + 1);
}

TreeStatistics gather_statistics(const TreeFlow& flow, const Viscosity& viscosity,
                                 parallel::Communicator comm) {
  const int k = flow.tree().generations();
  const Context context = make_context(flow, viscosity);
  std::vector<std::unique_ptr<Gatherer>> gatherers;
  for (int t = 0; t < parallel::thread_count(); ++t)
    gatherers.push_back(std::make_unique<Gatherer>(context, k));
  flow.sweep([&](int thread) -> VesselConsumer& { return *gatherers[static_cast<std::size_t>(thread)]; });

  TreeStatistics s;
  s.pressure_bins = context.pressure;
  s.flow_bins = context.flow;
  s.stress_bins = context.stress;
  const double ratio = context.vein_ratio;
  for (int generation = 0; generation < k; ++generation) {
    const auto at = static_cast<std::size_t>(generation);
    GenerationGatherer total(context, many_in(generation));
    GenerationStatistics g;
    for (const auto& gatherer : gatherers) {
      const GenerationGatherer& part = gatherer->generations()[at];
      total.add(part);
      part.flow_counts.add_to(g.flow_counts);
      for (std::size_t kind = 0; kind < 2; ++kind) {
        part.pressure_counts[kind].add_to(g.pressure_counts[kind]);
        part.stress_counts[kind].add_to(g.stress_counts[kind]);
      }
    }
    g.generation = generation;
    g.vessels = std::ldexp(1.0, generation);
    g.radius[0] = total.radius.spread(g.vessels, comm);
    g.radius[1] = {g.radius[0].mean * ratio, g.radius[0].least * ratio, g.radius[0].most * ratio};
    g.mean_length = total.length.sum.value(comm) / g.vessels;
    g.flow = total.flow.spread(g.vessels, comm);
    g.volume[0] = std::numbers::pi * total.volume.sum.value(comm);
    g.volume[1] = g.volume[0] * ratio * ratio;
    g.surface[0] = 2 * std::numbers::pi * total.surface.sum.value(comm);
    g.surface[1] = g.surface[0] * ratio;
    add_counts(g.flow_counts, comm);
    for (std::size_t kind = 0; kind < 2; ++kind) {
      g.pressure[kind] = total.pressure[kind].spread(g.vessels, comm);
      g.hoop_stress[kind] = total.stress[kind].spread(g.vessels, comm);
      add_counts(g.pressure_counts[kind], comm);
      add_counts(g.stress_counts[kind], comm);
      s.narrow_vessels += comm.all_reduce(total.narrow[kind], parallel::Reduce::sum);
    }
    s.volume += g.volume[0] + g.volume[1];
    s.surface += g.surface[0] + g.surface[1];
    s.generations.push_back(std::move(g));
  }
  return s;
}

}  // namespace rhexis::hemodynamics
