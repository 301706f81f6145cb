// SPDX-License-Identifier: BSD-3-Clause
/// What reduction leaves of a network: junctions of degree three and more whose pressures are unknown, and
/// junctions of fixed pressure.
///
///   sum over vessels j-k of g_jk (p_j - p_k) = i_j     at every unknown junction j; g in m3/(s Pa), i in
///   m3/s
///
/// At a contrast of 1e15 between conductances a double cannot hold the pressure differences along wide
/// vessels, so that flows cannot be formed from it. A pressure is therefore carried as the unevaluated sum of
/// two doubles, and a flow is g ((high_j - high_k) + (low_j - low_k)).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "parallel/shared_values.hpp"

namespace rhexis::hemodynamics {

struct CoreVessel {
  std::uint32_t tail = 0, head = 0;  ///< core junctions
  double conductance = 0;
};

/// A pressure as high + low.
struct TwoDoubles {
  double high = 0, low = 0;
};

/// Over several ranks each holds its own vessels and the junctions that these touch. A junction on several
/// ranks is owned by one; `share` says which. Vectors are [junctions]; results of sums are right at owned
/// ones.
class CoreSystem {
 public:
  /// Junctions [0, unknowns) are unknown; the others have the pressures `fixed`, and `injection` is
  /// [junctions]: what flows in through conditions of flow, m3/s. No vessel joins a junction to itself.
  CoreSystem(std::size_t unknowns, std::vector<CoreVessel> vessels, std::vector<double> injection,
             std::span<const double> fixed, double inflow_by_conditions);

  /// This rank owns the unknowns [0, owned); `shared`, in the numbers of this core, outlives the system.
  void share(std::size_t owned, parallel::SharedValues& shared);

  std::size_t unknowns() const { return unknowns_; }
  std::size_t owned() const { return owned_; }
  std::size_t junctions() const { return pressure_.size(); }
  std::size_t entries() const { return column_.size(); }

  /// Row j of the Laplacian, this rank's part: neighbours (unknown or fixed; one several times where vessels
  /// are parallel).
  std::span<const std::uint32_t> neighbours(std::size_t j) const {
    return {column_.data() + first_[j], column_.data() + first_[j + 1]};
  }
  std::span<const double> weights(std::size_t j) const {
    return {weight_.data() + first_[j], weight_.data() + first_[j + 1]};
  }
  double weight_sum(std::size_t j) const;

  /// result = A x over the unknowns, as differences; `x` is zero at fixed junctions. x of borrowed junctions
  /// is brought up to date.
  void apply(std::span<double> x, std::span<double> result, int threads) const;
  /// Injection less outflow at every unknown junction.
  void imbalance(std::span<double> result, int threads) const;
  /// p += x over the unknowns, without rounding.
  void add(std::span<double> x);

  double dot(std::span<const double> a, std::span<const double> b, int threads) const;
  /// Largest absolute value of the unknowns on all ranks; nan if any is nan.
  double largest(std::span<const double> a) const;
  /// Sum of the flows into the network through conditions, if pressures were p + x.
  double inflow(std::span<const double> x) const;
  /// Flows that two doubles can no longer tell from zero.
  double resolution() const;

  double flow(std::size_t vessel) const { return flow_along(vessels_[vessel]); }
  double pressure(std::size_t junction) const { return pressure_[junction].high; }

  void start_at(double pressure);
  /// Starts every unknown at a fixed pressure that it is connected to: where all those are equal, nothing
  /// flows, exactly. Returns an unknown that is connected to none, whose pressure is not defined;
  /// `unknowns()` where there is no such.
  std::size_t spread_fixed_pressures();

 private:
  double flow_along(const CoreVessel& vessel) const;

  std::size_t unknowns_, owned_;
  parallel::SharedValues* shared_ = nullptr;
  std::vector<CoreVessel> vessels_;
  std::vector<std::uint32_t> at_fixed_;  // vessels with an end of fixed pressure
  std::vector<double> injection_;
  std::vector<TwoDoubles> pressure_;
  std::vector<std::uint32_t> first_;   // [unknowns + 1]
  std::vector<std::uint32_t> column_;  // [entries]
  std::vector<double> weight_;
  mutable std::vector<double> outflow_;  // of `inflow`
  double inflow_by_conditions_;
};

}  // namespace rhexis::hemodynamics
