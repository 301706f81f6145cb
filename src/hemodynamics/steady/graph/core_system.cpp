// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/graph/core_system.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "hemodynamics/steady/graph/vector_operations.hpp"
#include "parallel/threads.hpp"

namespace rhexis::hemodynamics {

CoreSystem::CoreSystem(std::size_t unknowns, std::vector<CoreVessel> vessels, std::vector<double> injection,
                       std::span<const double> fixed, double inflow_by_conditions)
    : unknowns_(unknowns),
      owned_(unknowns),
      vessels_(std::move(vessels)),
      injection_(std::move(injection)),
      pressure_(unknowns + fixed.size()),
      first_(unknowns + 1),
      outflow_(unknowns + fixed.size()),
      inflow_by_conditions_(inflow_by_conditions) {
  for (std::size_t f = 0; f < fixed.size(); ++f) pressure_[unknowns + f].high = fixed[f];
  for (std::uint32_t v = 0; v < vessels_.size(); ++v) {
    const auto [tail, head, conductance] = vessels_[v];
    if (tail < unknowns) ++first_[tail];
    if (head < unknowns) ++first_[head];
    if (tail >= unknowns || head >= unknowns) at_fixed_.push_back(v);
  }
  std::inclusive_scan(first_.begin(), first_.end(), first_.begin());
  column_.resize(first_.back());
  weight_.resize(first_.back());
  for (std::size_t v = vessels_.size(); v-- > 0;) {
    const auto [tail, head, conductance] = vessels_[v];
    const auto put = [&, g = conductance](std::uint32_t row, std::uint32_t column) {
      if (row >= unknowns_) return;
      column_[--first_[row]] = column;
      weight_[first_[row]] = g;
    };
    put(head, tail);
    put(tail, head);
  }
}

double CoreSystem::weight_sum(std::size_t j) const {
  const auto row = weights(j);
  return std::accumulate(row.begin(), row.end(), 0.0);
}

void CoreSystem::share(std::size_t owned, parallel::SharedValues& shared) {
  owned_ = owned;
  shared_ = &shared;
}

void CoreSystem::start_at(double pressure) {
  std::fill_n(pressure_.begin(), unknowns_, TwoDoubles{pressure, 0});
}

void CoreSystem::apply(std::span<double> x, std::span<double> result, int threads) const {
  if (shared_ != nullptr) shared_->copy_from_owner(x);
  parallel::for_each_share(threads, unknowns_, [&](int, std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      double sum = 0;
      for (std::uint32_t k = first_[j]; k < first_[j + 1]; ++k) sum += weight_[k] * (x[j] - x[column_[k]]);
      result[j] = sum;
    }
  });
  if (shared_ != nullptr) shared_->add_to_owner(result);
}

void CoreSystem::imbalance(std::span<double> result, int threads) const {
  parallel::for_each_share(threads, unknowns_, [&](int, std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      double sum = injection_[j];
      for (std::uint32_t k = first_[j]; k < first_[j + 1]; ++k) {
        const TwoDoubles here = pressure_[j], there = pressure_[column_[k]];
        sum -= weight_[k] * ((here.high - there.high) + (here.low - there.low));
      }
      result[j] = sum;
    }
  });
  if (shared_ != nullptr) shared_->add_to_owner(result);
}

void CoreSystem::add(std::span<double> x) {
  if (shared_ != nullptr) shared_->copy_from_owner(x);
  for (std::size_t j = 0; j < unknowns_; ++j) {
    auto& [high, low] = pressure_[j];
    const double sum = high + x[j], part = sum - high;
    low += (high - (sum - part)) + (x[j] - part);
    high = sum + low;
    low -= high - sum;
  }
}

double CoreSystem::flow_along(const CoreVessel& vessel) const {
  const TwoDoubles tail = pressure_[vessel.tail], head = pressure_[vessel.head];
  return vessel.conductance * ((tail.high - head.high) + (tail.low - head.low));
}

double CoreSystem::dot(std::span<const double> a, std::span<const double> b, int threads) const {
  const double sum = hemodynamics::dot(a.first(owned_), b.first(owned_), threads);
  return shared_ == nullptr ? sum : shared_->communicator().all_reduce(sum, parallel::Reduce::sum);
}

double CoreSystem::largest(std::span<const double> a) const {
  const double mine = hemodynamics::largest(a.first(owned_));
  if (shared_ == nullptr) return mine;
  // The largest of MPI may pass over nan, a sum does not.
  const double poison = shared_->communicator().all_reduce(0 * mine, parallel::Reduce::sum);
  return shared_->communicator().all_reduce(mine, parallel::Reduce::max) + poison;
}

double CoreSystem::inflow(std::span<const double> x) const {
  std::fill(outflow_.begin(), outflow_.end(), 0.0);
  for (std::size_t j = unknowns_; j < junctions(); ++j) outflow_[j] = -injection_[j];
  for (const std::uint32_t v : at_fixed_) {
    const auto& [tail, head, conductance] = vessels_[v];
    const double flow = flow_along(vessels_[v]) + conductance * (x[tail] - x[head]);
    outflow_[tail] += flow;
    outflow_[head] -= flow;
  }
  if (shared_ != nullptr) {
    shared_->add_to_owner(outflow_);
    for (const auto& link : shared_->links()) {
      for (const std::uint32_t j : link.borrowed) outflow_[j] = 0;
    }
  }
  double sum = inflow_by_conditions_;
  for (std::size_t j = unknowns_; j < junctions(); ++j) sum += std::max(outflow_[j], 0.0);
  return shared_ == nullptr ? sum : shared_->communicator().all_reduce(sum, parallel::Reduce::sum);
}

double CoreSystem::resolution() const {
  double most = 0;
  for (const auto& [tail, head, conductance] : vessels_) {
    const double pressure = std::max(std::abs(pressure_[tail].high), std::abs(pressure_[head].high));
    most = std::max(most, conductance * pressure);
  }
  if (shared_ != nullptr) most = shared_->communicator().all_reduce(most, parallel::Reduce::max);
  return 0x1p-98 * most;
}

std::size_t CoreSystem::spread_fixed_pressures() {
  std::vector<bool> reached(unknowns_);
  std::vector<std::uint32_t> front;
  const auto reach = [&](std::uint32_t j, double pressure) {
    if (j >= unknowns_ || reached[j]) return;
    reached[j] = true;
    pressure_[j] = {pressure, 0};
    front.push_back(j);
  };
  for (const std::uint32_t v : at_fixed_) {
    const auto& [tail, head, conductance] = vessels_[v];
    if (tail >= unknowns_) reach(head, pressure_[tail].high);
    if (head >= unknowns_) reach(tail, pressure_[head].high);
  }
  while (!front.empty()) {
    const std::uint32_t j = front.back();
    front.pop_back();
    for (const std::uint32_t k : neighbours(j)) reach(k, pressure_[j].high);
  }
  return static_cast<std::size_t>(std::find(reached.begin(), reached.end(), false) - reached.begin());
}

}  // namespace rhexis::hemodynamics
