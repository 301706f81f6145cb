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

namespace rhexis::hemodynamics {

struct CoreVessel {
  std::uint32_t tail = 0, head = 0;  ///< core junctions
  double conductance = 0;
};

/// A pressure as high + low.
struct TwoDoubles {
  double high = 0, low = 0;
};

class CoreSystem {
 public:
  /// Junctions [0, unknowns) are unknown; the others have the pressures `fixed`, and `injection` is
  /// [unknowns + fixed]: what flows in through conditions of flow, m3/s. No vessel joins a junction to
  /// itself.
  CoreSystem(std::size_t unknowns, std::vector<CoreVessel> vessels, std::vector<double> injection,
             std::span<const double> fixed, double inflow_by_conditions);

  std::size_t unknowns() const { return unknowns_; }
  std::size_t junctions() const { return pressure_.size(); }
  std::size_t entries() const { return column_.size(); }

  /// Row j of the Laplacian: neighbours (unknown or fixed; one several times where vessels are parallel).
  std::span<const std::uint32_t> neighbours(std::size_t j) const {
    return {column_.data() + first_[j], column_.data() + first_[j + 1]};
  }
  std::span<const double> weights(std::size_t j) const {
    return {weight_.data() + first_[j], weight_.data() + first_[j + 1]};
  }
  double weight_sum(std::size_t j) const;

  /// result = A x over the unknowns, as differences; `x` is [junctions], zero at fixed ones.
  void apply(std::span<const double> x, std::span<double> result, int threads) const;
  /// Injection less outflow at every unknown junction.
  void imbalance(std::span<double> result, int threads) const;
  /// p += x over the unknowns, without rounding.
  void add(std::span<const double> x);

  /// Sum of the flows into the network through conditions, if pressures were p + x.
  double inflow(std::span<const double> x) const;
  /// Flows that two doubles can no longer tell from zero.
  double resolution() const;

  double flow(std::size_t vessel) const { return flow_along(vessels_[vessel]); }
  double pressure(std::size_t junction) const { return pressure_[junction].high; }

  /// Starts every unknown at a fixed pressure that it is connected to: where all those are equal, nothing
  /// flows, exactly. Returns an unknown that is connected to none, whose pressure is not defined;
  /// `unknowns()` where there is no such.
  std::size_t spread_fixed_pressures();

 private:
  double flow_along(const CoreVessel& vessel) const;

  std::size_t unknowns_;
  std::vector<CoreVessel> vessels_;
  std::vector<std::uint32_t> at_fixed_;  // vessels with an end of fixed pressure
  std::vector<double> injection_;
  std::vector<TwoDoubles> pressure_;
  std::vector<std::uint32_t> first_;   // [unknowns + 1]
  std::vector<std::uint32_t> column_;  // [entries]
  std::vector<double> weight_;
  mutable std::vector<double> out_of_fixed_;
  double inflow_by_conditions_;
};

}  // namespace rhexis::hemodynamics
