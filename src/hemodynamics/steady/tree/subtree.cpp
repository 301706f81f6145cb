// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/tree/subtree.hpp"

#include <algorithm>

#include "hemodynamics/steady/tree/lanes.hpp"

namespace rhexis::hemodynamics {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using lanes::Real;
using lanes::Reals;
using lanes::width;
using lanes::Word;
using lanes::Words;

constexpr std::size_t arrays = 12;

std::size_t first_of(int l) {
  return std::size_t{1} << l;
}

/// Resistance of two side by side.
HWY_INLINE Real parallel(Real a, Real b) {
  return hn::Div(hn::Mul(a, b), hn::Add(a, b));
}
double parallel(double a, double b) {
  return a * b / (a + b);
}

}  // namespace

Subtree::Subtree(const TreeLaw& law, int depth, bool open) : law_(law), depth_(depth), open_(open) {
  const std::size_t size = std::max<std::size_t>(first_of(open ? depth + 1 : depth), 2 * width);
  // Odd multiples of a cache line apart, so that equal indices do not meet in the same cache sets.
  const std::size_t stride = size + 8;
  memory_ = hwy::AllocateAligned<double>(arrays * stride);
  std::fill_n(memory_.get(), arrays * stride, 0.0);
  double** const array[arrays] = {&capacity_,   &artery_,    &vein_,     &below_,  &flow_,   &artery_near_,
                                  &artery_far_, &vein_near_, &vein_far_, &radius_, &length_, &factor_};
  for (std::size_t i = 0; i < arrays; ++i) *array[i] = memory_.get() + i * stride;
}

/// A number for every place of generation l, from its random word.
template <class InLanes, class Scalar>
void Subtree::draw_level(network::Stream stream, int l, double* out, const InLanes& in_lanes,
                         const Scalar& scalar) const {
  lanes::draw_each(law_.seed, stream, place_ << l, first_of(l), out + first_of(l), in_lanes, scalar);
}

/// Capacities of the daughters of generation l.
void Subtree::split(int l) {
  const Reals d;
  double* share = flow_;  // free until `fall`
  const std::size_t first = first_of(l);
  const double fixed = 0.5 + law_.least_offset;
  if (law_.random_splits) {
    const auto least = hn::Set(d, law_.least_offset), range = hn::Set(d, law_.offset_range);
    draw_level(
        network::Stream::splits, l, share,
        [&](Word bits) {
          const Real offset = hn::Add(least, hn::Mul(range, lanes::even_share(bits)));
          return hn::Add(hn::Set(d, 0.5), lanes::signed_by_coin(bits, offset));
        },
        [&](std::uint32_t bits) {
          const double offset = law_.least_offset + law_.offset_range * network::even_share(bits);
          return network::coin(bits) ? 0.5 - offset : 0.5 + offset;
        });
  } else {
    std::fill_n(share + first, first, fixed);
  }
  if (first < width) {
    for (std::size_t n = first; n < 2 * first; ++n) {
      capacity_[2 * n] = capacity_[n] * share[n];
      capacity_[2 * n + 1] = capacity_[n] - capacity_[2 * n];
    }
    return;
  }
  for (std::size_t n = first; n < 2 * first; n += width) {
    const Real parent = hn::Load(d, capacity_ + n);
    const Real one = hn::Mul(parent, hn::Load(d, share + n));
    hn::StoreInterleaved2(one, hn::Sub(parent, one), d, capacity_ + 2 * n);
  }
}

void Subtree::set_resistances(int l) {
  const Reals d;
  const std::size_t first = first_of(l);
  const double generation_factor = law_.generation_factor[static_cast<std::size_t>(generation_ + l)];
  if (law_.random_lengths) {
    const auto base = hn::Set(d, 1 - law_.length_spread), range = hn::Set(d, 2 * law_.length_spread);
    const auto general = hn::Set(d, generation_factor);
    draw_level(
        network::Stream::lengths, l, factor_,
        [&](Word bits) { return hn::Mul(general, hn::Add(base, hn::Mul(range, lanes::even_share(bits)))); },
        [&](std::uint32_t bits) {
          return generation_factor *
                 (1 - law_.length_spread + 2 * law_.length_spread * network::even_share(bits));
        });
  } else {
    std::fill_n(factor_ + first, first, generation_factor);
  }
  if (first < width) {
    for (std::size_t n = first; n < 2 * first; ++n) {
      artery_[n] = factor_[n] * law_.artery_resistance(capacity_[n]);
      if (!law_.vein_follows) vein_[n] = factor_[n] * law_.vein_resistance(capacity_[n]);
    }
    return;
  }
  for (std::size_t n = first; n < 2 * first; n += width) {
    const Real a = hn::Load(d, capacity_ + n), factor = hn::Load(d, factor_ + n);
    hn::Store(hn::Mul(factor, lanes::value_of(law_.artery_resistance, a)), d, artery_ + n);
    if (!law_.vein_follows)
      hn::Store(hn::Mul(factor, lanes::value_of(law_.vein_resistance, a)), d, vein_ + n);
  }
}

void Subtree::grow(std::uint64_t place, double capacity) {
  place_ = place;
  generation_ = network::TreePair::generation_of(place);
  capacity_[1] = capacity;
  for (int l = 0; l < depth_; ++l) {
    if (open_ || l + 1 < depth_) split(l);
    set_resistances(l);
  }
}

void Subtree::rise(int l) {
  const Reals d;
  const bool last = !open_ && l + 1 == depth_;
  const std::size_t first = first_of(l);
  if (first < width) {
    for (std::size_t n = first; n < 2 * first; ++n) {
      below_[n] = artery_[n] + vein_resistance(n) + (last ? 0 : parallel(below_[2 * n], below_[2 * n + 1]));
    }
    return;
  }
  const auto follow = hn::Set(d, law_.vein_factor);
  for (std::size_t n = first; n < 2 * first; n += width) {
    const Real artery = hn::Load(d, artery_ + n);
    const Real vein = law_.vein_follows ? hn::Mul(artery, follow) : hn::Load(d, vein_ + n);
    Real total = hn::Add(artery, vein);
    if (!last) {
      Real one, two;
      hn::LoadInterleaved2(d, below_ + 2 * n, one, two);
      total = hn::Add(total, parallel(one, two));
    }
    hn::Store(total, d, below_ + n);
  }
}

double Subtree::rise() {
  for (int l = depth_ - 1; l >= 0; --l) rise(l);
  return below_[1];
}

/// Far pressures of generation l, and what its daughters get.
void Subtree::fall(int l) {
  const Reals d;
  const bool last = !open_ && l + 1 == depth_;
  const std::size_t first = first_of(l);
  if (first < width) {
    for (std::size_t n = first; n < 2 * first; ++n) {
      artery_far_[n] = artery_near_[n] - flow_[n] * artery_[n];
      vein_far_[n] = vein_near_[n] + flow_[n] * vein_resistance(n);
      if (last) continue;
      const double one = below_[2 * n], two = below_[2 * n + 1], part = flow_[n] / (one + two);
      flow_[2 * n] = part * two;
      flow_[2 * n + 1] = part * one;
      artery_near_[2 * n] = artery_near_[2 * n + 1] = artery_far_[n];
      vein_near_[2 * n] = vein_near_[2 * n + 1] = vein_far_[n];
    }
    return;
  }
  const auto follow = hn::Set(d, law_.vein_factor);
  for (std::size_t n = first; n < 2 * first; n += width) {
    const Real artery = hn::Load(d, artery_ + n), flow = hn::Load(d, flow_ + n);
    const Real vein = law_.vein_follows ? hn::Mul(artery, follow) : hn::Load(d, vein_ + n);
    const Real artery_far = hn::Sub(hn::Load(d, artery_near_ + n), hn::Mul(flow, artery));
    const Real vein_far = hn::Add(hn::Load(d, vein_near_ + n), hn::Mul(flow, vein));
    hn::Store(artery_far, d, artery_far_ + n);
    hn::Store(vein_far, d, vein_far_ + n);
    if (last) continue;
    Real one, two;
    hn::LoadInterleaved2(d, below_ + 2 * n, one, two);
    const Real part = hn::Div(flow, hn::Add(one, two));
    hn::StoreInterleaved2(hn::Mul(part, two), hn::Mul(part, one), d, flow_ + 2 * n);
    hn::StoreInterleaved2(artery_far, artery_far, d, artery_near_ + 2 * n);
    hn::StoreInterleaved2(vein_far, vein_far, d, vein_near_ + 2 * n);
  }
}

void Subtree::fall(const SubtreeState& state) {
  flow_[1] = state.flow;
  artery_near_[1] = state.artery_pressure;
  vein_near_[1] = state.vein_pressure;
  for (int l = 0; l < depth_; ++l) fall(l);
}

SubtreeState Subtree::daughter(std::size_t i) const {
  const std::size_t n = first_of(depth_) + i;
  return {(place_ << depth_) + i, capacity_[n], flow_[n], artery_near_[n], vein_near_[n]};
}

std::uint64_t Subtree::global_place(std::size_t n) const {
  const int l = network::TreePair::generation_of(n);
  return (place_ << l) + n - first_of(l);
}

void Subtree::state_of(std::size_t n, double values[5]) const {
  const double all[5] = {flow_[n], artery_near_[n], artery_far_[n], vein_near_[n], vein_far_[n]};
  std::copy_n(all, 5, values);
}

VesselBlock Subtree::block(int l, bool with_geometry) {
  const std::size_t first = first_of(l);
  VesselBlock b;
  b.generation = generation_ + l;
  b.first_place = place_ << l;
  b.count = first;
  b.flow = flow_ + first;
  b.artery_near = artery_near_ + first;
  b.artery_far = artery_far_ + first;
  b.vein_near = vein_near_ + first;
  b.vein_far = vein_far_ + first;
  if (!with_geometry) return b;
  b.radius = radius_ + first;
  b.length = length_ + first;
  if (first < width) {
    for (std::size_t n = first; n < 2 * first; ++n) {
      radius_[n] = law_.radius(capacity_[n]);
      length_[n] = factor_[n] * (law_.length_is_radius ? radius_[n] : law_.length(capacity_[n]));
    }
    return b;
  }
  const Reals d;
  for (std::size_t n = first; n < 2 * first; n += width) {
    const Real a = hn::Load(d, capacity_ + n);
    const Real radius = lanes::value_of(law_.radius, a);
    const Real length = law_.length_is_radius ? radius : lanes::value_of(law_.length, a);
    hn::Store(radius, d, radius_ + n);
    hn::Store(hn::Mul(hn::Load(d, factor_ + n), length), d, length_ + n);
  }
  return b;
}

}  // namespace rhexis::hemodynamics
