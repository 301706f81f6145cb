// SPDX-License-Identifier: BSD-3-Clause
// The vessels of a tree, block by block.
#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <cmath>

#include "hemodynamics/steady/tree/lanes.hpp"
#include "network/wall.hpp"
#include "parallel/threads.hpp"
#include "studies/screening/screening.hpp"

namespace rhexis::screening {

namespace lanes = hemodynamics::lanes;
namespace hn = lanes::hn;
using hemodynamics::VesselBlock;
using lanes::Real;
using lanes::Reals;
using lanes::width;
using network::FactorStream;
using network::VesselKind;
using network::WallFactors;

constexpr VesselKind kinds[] = {VesselKind::artery, VesselKind::vein};

/// What all threads share.
struct TreeScreening::Context {
  const network::TreePair& tree;
  const network::WallVariation& variation;
  Criterion criterion;
  std::size_t top;
  network::IntervalTable thickness[2];  ///< h / r0 of the artery's radius, where it depends on that

  const network::Wall& wall(VesselKind kind) const {
    return kind == VesselKind::vein ? tree.rules().vein_wall : tree.rules().artery_wall;
  }
  double ratio(VesselKind kind) const {
    return kind == VesselKind::vein ? tree.rules().vein_radius_ratio : 1;
  }
  double relative_thickness(VesselKind kind, double artery_radius) const {
    return wall(kind).relative_thickness(artery_radius * ratio(kind));
  }
};

class TreeScreening::Consumer : public hemodynamics::VesselConsumer {
 public:
  explicit Consumer(const Context& context) : c_(context), tally_(context.tree.generations(), context.top) {}

  void consume(const VesselBlock& b) override {
    for (const VesselKind kind : kinds) {
      if (b.multiplicity == 1) {
        screen(b, kind);
      } else {
        screen_alike(b, kind);
      }
    }
  }

  const RiskTally& tally() const { return tally_; }

 private:
  static double pressure(const VesselBlock& b, VesselKind kind, std::size_t i) {
    return kind == VesselKind::artery ? 0.5 * (b.artery_near[i] + b.artery_far[i])
                                      : 0.5 * (b.vein_near[i] + b.vein_far[i]);
  }
  double risk_of(const VesselBlock& b, VesselKind kind, std::size_t i, const WallFactors& wall) const {
    return risk(c_.criterion, pressure(b, kind, i), c_.relative_thickness(kind, b.radius[i]), wall);
  }

  /// One vessel stands for its generation; the marked ones of that are another.
  void screen_alike(const VesselBlock& b, VesselKind kind) {
    const auto all = static_cast<std::uint64_t>(b.multiplicity);
    std::uint64_t marked = 0, usual = b.first_place;
    const auto ranges = c_.variation.marked_in(kind, b.first_place, b.first_place + all);
    for (const auto& range : ranges) {
      if (usual == range.first) usual = range.past;
      marked += range.past - range.first;
    }
    const auto add = [&](std::uint64_t place, std::uint64_t alike) {
      if (alike == 0) return;
      tally_.add(b.generation, kind,
                 {risk_of(b, kind, 0, c_.variation.of(kind, place)), network::TreePair::id_of(place, kind),
                  static_cast<double>(alike)});
    };
    if (marked > 0) add(ranges.front().first, marked);
    add(usual, all - marked);
  }

  void screen(const VesselBlock& b, VesselKind kind) {
    make_room(std::max(b.count, width));
    const bool few = b.count < width;
    if (few) {
      for (std::size_t i = 0; i < b.count; ++i)
        risk_[i] = risk_of(b, kind, i, c_.variation.of(kind, b.first_place + i));
    } else {
      draw(c_.variation.strength(), b, kind, strength_);
      draw(c_.variation.thickness(), b, kind, thickness_);
      find_risks(b, kind);
    }
    for (const auto& range : c_.variation.marked_in(kind, b.first_place, b.first_place + b.count)) {
      for (std::uint64_t place = range.first; place < range.past && !few; ++place)
        risk_[place - b.first_place] = risk_of(b, kind, place - b.first_place, c_.variation.of(kind, place));
    }
    tally_.add(b.generation, kind, b.first_place, risk_, b.count);
  }

  void make_room(std::size_t count) {
    if (count <= room_) return;
    room_ = count;  // a power of two, so all arrays are aligned
    memory_ = hwy::AllocateAligned<double>(3 * count);
    risk_ = memory_.get();
    std::fill_n(risk_, 3 * count, 0.0);
    strength_ = risk_ + count;
    thickness_ = strength_ + count;
  }

  void draw(const FactorStream& stream, const VesselBlock& b, VesselKind kind, double* out) const {
    if (!stream.varies()) return;
    const Reals d;
    lanes::draw_each(
        stream.seed(), stream.stream(kind), b.first_place, b.count, out,
        [&](lanes::Word bits) {
          const Real below =
              lanes::value_of(stream.lower(), hn::Mul(hn::Set(d, 0.5), lanes::even_share(bits)));
          const auto above = hn::Lt(lanes::signed_by_coin(bits, below), hn::Zero(d));
          return hn::IfThenElse(above, hn::Div(hn::Set(d, stream.product()), below), below);
        },
        [&](std::uint32_t) { return 1.0; });  // no block is this small
  }

  void find_risks(const VesselBlock& b, VesselKind kind) {
    const Reals d;
    const bool artery = kind == VesselKind::artery;
    const double* const near = artery ? b.artery_near : b.vein_near;
    const double* const far = artery ? b.artery_far : b.vein_far;
    const bool varies_strength = c_.variation.strength().varies();
    const bool varies_thickness = c_.variation.thickness().varies();
    const bool by_radius = c_.wall(kind).rule == network::WallRule::radius;
    const network::IntervalTable& table = c_.thickness[artery ? 0 : 1];
    const auto half = hn::Set(d, 0.5), one = hn::Set(d, 1.0);
    const auto outside = hn::Set(d, c_.criterion.outside_pressure);
    const auto constant = hn::Set(d, c_.wall(kind).ratio), nu = hn::Set(d, c_.criterion.poisson_ratio);
    const auto limit = hn::Set(d, c_.criterion.young_modulus * c_.criterion.critical_stretch);
    for (std::size_t i = 0; i < b.count; i += width) {
      Real h = by_radius ? lanes::value_of(table, hn::LoadU(d, b.radius + i)) : constant;
      if (varies_thickness) h = hn::Mul(h, hn::Load(d, thickness_ + i));
      const Real p = hn::Sub(hn::Mul(half, hn::Add(hn::LoadU(d, near + i), hn::LoadU(d, far + i))), outside);
      const Real square = hn::Mul(hn::Add(one, h), hn::Add(one, h));
      const Real less = hn::Sub(square, one);
      // (square + 1) / (square - 1) + nu, over E s0 (network/wall.hpp), with one division.
      const Real above = hn::Mul(p, hn::Add(hn::Add(square, one), hn::Mul(nu, less)));
      Real below = hn::Mul(limit, less);
      if (varies_strength) below = hn::Mul(below, hn::Load(d, strength_ + i));
      hn::Store(hn::Div(above, below), d, risk_ + i);
    }
  }

  const Context& c_;
  RiskTally tally_;
  hwy::AlignedFreeUniquePtr<double[]> memory_;
  std::size_t room_ = 0;  ///< vessels for which each array has room
  double *risk_ = nullptr, *strength_ = nullptr, *thickness_ = nullptr;
};

TreeScreening::TreeScreening(const network::TreePair& tree, const network::WallVariation& variation,
                             const Criterion& criterion, std::size_t top)
    : context_(new Context{tree, variation, criterion, top, {}}) {
  const double widest = tree.rules().root_radius * (1 + 1e-6);
  const double narrowest = tree.radius_of(tree.least_capacity()) * (1 - 1e-6);
  for (std::size_t k = 0; k < 2; ++k) {
    const network::Wall& wall = context_->wall(kinds[k]);
    const double ratio = context_->ratio(kinds[k]);
    if (wall.rule != network::WallRule::radius) continue;
    context_->thickness[k] = network::IntervalTable(
        [=](long double r) { return wall.relative_thickness(r * ratio); }, narrowest, widest);
  }
  for (int t = 0; t < parallel::thread_count(); ++t)
    consumers_.push_back(std::make_unique<Consumer>(*context_));
}

TreeScreening::~TreeScreening() = default;

hemodynamics::VesselConsumer& TreeScreening::consumer(int thread) {
  return *consumers_[static_cast<std::size_t>(thread)];
}

Screening TreeScreening::result(parallel::Communicator comm) const {
  RiskTally all = consumers_.front()->tally();
  for (std::size_t t = 1; t < consumers_.size(); ++t) all.add(consumers_[t]->tally());
  return all.result(comm);
}

}  // namespace rhexis::screening
