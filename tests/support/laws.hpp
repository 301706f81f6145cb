// SPDX-License-Identifier: BSD-3-Clause
// One bond's law on one lane, for tests from a table of stretches.
#pragma once

#include <vector>

#include "peridynamics/laws/numbers.hpp"

namespace rhexis::test {

/// A law's factors as the kernel finds them, in a vector of one lane.
template <class Law, class Real>
Real force_factor(const Law& law, Real t) {
  using X = peridynamics::Lanes<hwy::HWY_NAMESPACE::CappedTag<Real, 1>>;
  return hwy::HWY_NAMESPACE::GetLane(law.force_factor(X(t)).vector);
}

template <class Law, class Real>
Real energy_factor(const Law& law, Real t) {
  using X = peridynamics::Lanes<hwy::HWY_NAMESPACE::CappedTag<Real, 1>>;
  return hwy::HWY_NAMESPACE::GetLane(law.energy_factor(X(t)).vector);
}

/// t of a stretch s, in the precision of the kernel.
template <class Real>
Real t_of(long double s) {
  return static_cast<Real>(s * (2 + s));
}

inline const std::vector<long double> stretches = {-0.9L, -0.5L, -0.1L, -1e-3L, -1e-5L, 1e-5L,
                                                   1e-3L, 0.05L, 0.1L,  0.25L,  2.0L};

}  // namespace rhexis::test
