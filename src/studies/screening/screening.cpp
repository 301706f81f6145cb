// SPDX-License-Identifier: BSD-3-Clause
#include "studies/screening/screening.hpp"

#include <algorithm>
#include <cmath>

#include "hemodynamics/steady/tree/bin_finder.hpp"
#include "network/wall.hpp"
#include "parallel/exchange.hpp"

namespace rhexis::screening {
namespace {

namespace hn = hemodynamics::lanes::hn;
using hemodynamics::lanes::Reals;
using hemodynamics::lanes::width;

/// Four bins to an octave, from below 64 down to 2^-10.
const hemodynamics::Bins risk_bins{true, 64, 0, 63.5};
const hemodynamics::BinFinder find_bin(risk_bins);

/// Order of the list.
bool before(const RankedVessel& a, const RankedVessel& b) {
  return a.risk != b.risk ? a.risk > b.risk : a.vessel < b.vessel;
}

std::size_t side(network::VesselKind kind) {
  return kind == network::VesselKind::vein ? 1 : 0;
}

}  // namespace

double risk(const Criterion& c, double pressure, double relative_thickness,
            const network::WallFactors& wall) {
  return network::lumen_hoop_strain(pressure - c.outside_pressure, relative_thickness * wall.thickness,
                                    c.young_modulus, c.poisson_ratio) /
         (c.critical_stretch * wall.strength);
}

RiskTally::RiskTally(int generations, std::size_t top)
    : most_(top), generations_(static_cast<std::size_t>(generations) + 1) {
  for (GenerationRisk& g : generations_) {
    for (auto& counts : g.counts) counts.resize(risk_bins.count);
  }
}

void RiskTally::enter(const RankedVessel& vessel) {
  if (list_.size() == most_) {
    if (!before(vessel, list_.front())) return;
    std::pop_heap(list_.begin(), list_.end(), before);
    list_.pop_back();
  }
  list_.push_back(vessel);
  std::push_heap(list_.begin(), list_.end(), before);
}

void RiskTally::add(int generation, network::VesselKind kind, const RankedVessel& vessel) {
  GenerationRisk& g = generations_[static_cast<std::size_t>(generation + 1)];
  const std::size_t k = side(kind);
  g.vessels[k] += vessel.alike;
  g.most[k] = std::max(g.most[k], vessel.risk);
  if (vessel.risk > 1) g.above[k] += vessel.alike;
  const auto bin = hn::GetLane(find_bin(hn::Set(Reals(), vessel.risk)));
  g.counts[k][static_cast<std::size_t>(bin)] += static_cast<std::uint64_t>(vessel.alike);
  if (enters(vessel.risk)) enter(vessel);
}

void RiskTally::add(int generation, network::VesselKind kind, std::uint64_t first, const double* risks,
                    std::size_t count) {
  const Reals d;
  const hemodynamics::BinFinder::Integers di;
  GenerationRisk& g = generations_[static_cast<std::size_t>(generation + 1)];
  const std::size_t k = side(kind);
  std::uint64_t* const counts = g.counts[k].data();
  const auto id = [&](std::size_t i) { return network::TreePair::id_of(first + i, kind); };
  alignas(64) std::int64_t bin[width];
  auto most = hn::Set(d, g.most[k]);
  std::size_t above = 0;
  for (std::size_t i = 0; i < count; i += width) {
    const std::size_t here = std::min(width, count - i);
    const auto valid = hn::FirstN(d, here);
    const auto r = hn::Load(d, risks + i);
    most = hn::Max(most, hn::IfThenElseZero(valid, r));
    above += hn::CountTrue(d, hn::And(valid, hn::Gt(r, hn::Set(d, 1.0))));
    hn::Store(find_bin(r), di, bin);
    for (std::size_t n = 0; n < here; ++n) ++counts[bin[n]];
    const double least = list_.size() < most_ || list_.empty() ? 0 : list_.front().risk;
    if (hn::AllFalse(d, hn::And(valid, hn::Ge(r, hn::Set(d, least))))) continue;
    for (std::size_t n = 0; n < here; ++n) {
      if (enters(risks[i + n])) enter({risks[i + n], id(i + n), 1});
    }
  }
  g.most[k] = hn::GetLane(hn::MaxOfLanes(d, most));
  g.above[k] += static_cast<double>(above);
  g.vessels[k] += static_cast<double>(count);
}

void RiskTally::add(const RiskTally& other) {
  for (const RankedVessel& vessel : other.list_) enter(vessel);
  for (std::size_t i = 0; i < generations_.size(); ++i) {
    GenerationRisk& to = generations_[i];
    const GenerationRisk& from = other.generations_[i];
    for (std::size_t k = 0; k < 2; ++k) {
      to.vessels[k] += from.vessels[k];
      to.above[k] += from.above[k];
      to.most[k] = std::max(to.most[k], from.most[k]);
      for (std::size_t b = 0; b < risk_bins.count; ++b) to.counts[k][b] += from.counts[k][b];
    }
  }
}

Screening RiskTally::result(parallel::Communicator comm) const {
  Screening s;
  s.bins = risk_bins;
  s.generations = generations_;
  for (GenerationRisk& g : s.generations) {
    comm.all_reduce(g.vessels, parallel::Reduce::sum);
    comm.all_reduce(g.above, parallel::Reduce::sum);
    comm.all_reduce(g.most, parallel::Reduce::max);
    for (auto& counts : g.counts) comm.all_reduce(counts, parallel::Reduce::sum);
    for (std::size_t k = 0; k < 2; ++k) {
      s.vessels += g.vessels[k];
      s.above += g.above[k];
    }
  }
  s.top = parallel::all_gather(comm, list_).records;
  std::sort(s.top.begin(), s.top.end(), before);
  if (s.top.size() > most_) s.top.resize(most_);
  return s;
}

}  // namespace rhexis::screening
