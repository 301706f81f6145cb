// One bond's law on one lane, for tests from a table of stretches.
#pragma once

#include <hwy/highway.h>

#include <vector>

namespace rhexis::test {

template <class Law, class Real>
Real force_factor(const Law& law, Real t) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::CappedTag<Real, 1> d;
  return hn::GetLane(law.force_factor(d, hn::Set(d, t)));
}

template <class Law, class Real>
Real energy_factor(const Law& law, Real t) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::CappedTag<Real, 1> d;
  return hn::GetLane(law.energy_factor(d, hn::Set(d, t)));
}

/// t of a stretch s, in the precision of the kernel.
template <class Real>
Real t_of(long double s) {
  return static_cast<Real>(s * (2 + s));
}

inline const std::vector<long double> stretches = {-0.9L, -0.5L, -0.1L, -1e-3L, -1e-5L, 1e-5L,
                                                   1e-3L, 0.05L, 0.1L,  0.25L,  2.0L};

}  // namespace rhexis::test
