// SPDX-License-Identifier: BSD-3-Clause
/// ColumnBody: one step in time.
#pragma once

#include "peridynamics/engine/column_body.hpp"

namespace rhexis::peridynamics {

template <class Law, class Real>
std::pair<std::int64_t, std::int64_t> ColumnBody<Law, Real>::local_free_rows(std::int64_t begin,
                                                                             std::int64_t past,
                                                                             int component) const {
  const std::pair<std::int64_t, std::int64_t>& free = free_rows_[static_cast<std::size_t>(component)];
  const std::int64_t first_row = domain_.layout().first_row;
  return {std::clamp(free.first - first_row, begin, past), std::clamp(free.second - first_row, begin, past)};
}

template <class Law, class Real>
std::pair<int, int> ColumnBody<Law, Real>::free_lanes(RowBlock b, int component) const {
  const std::int64_t begin = b.block * block_rows;
  const auto [first, past] = local_free_rows(begin, begin + domain_.rows_in(b.block), component);
  return {static_cast<int>(first - begin), static_cast<int>(past - begin)};
}

/// Looks for ruptured particles where bonds broke; to be called once all bonds that are due are broken.
template <class Law, class Real>
void ColumnBody<Law, Real>::look_for_rupture(ThreadEvents& events) const {
  for (const RowBlock b : events.broken_blocks) {
    if (!damaged_ && !events.damaged) events.damaged = bonds_.has_ruptured(b);
  }
  events.broken_blocks.clear();
}

/// Makes what forces need: a frame that follows the body, the halo, a state-based law's dilatations, and the
/// deformed lumen.
template <class Law, class Real>
void ColumnBody<Law, Real>::prepare_forces(std::vector<ThreadEvents>& per_thread) {
  if (steps_ % frame_interval == 0) displacement_.follow(u_, comm_);
  const auto u = displacement_.current();
  if constexpr (Law::state_based) {
    dilatation_->find(*kernel_input_, bonds_, halo_, u, per_thread);
    for (const ThreadEvents& t : per_thread) work_.add_released(t.released);
  } else {
    halo_.start(u);
    halo_.finish(u);
  }
  if (!follower_.none()) follower_.find_forces({u[0], u[1], u[2]}, displacement_.frame().wrapped());
}

/// The sum of 16 numbers, in an order that compilers find vectors in.
inline double sum_of_rows(const double (&row)[block_rows]) {
  static_assert(block_rows == 16);
  double eight[8], four[4];
  for (int i = 0; i < 8; ++i) eight[i] = row[i] + row[i + 8];
  for (int i = 0; i < 4; ++i) four[i] = eight[i] + eight[i + 4];
  return (four[0] + four[2]) + (four[1] + four[3]);
}

/// Adds the load to the velocity of a subdomain's rows of a column, and its work over the step to `work`.
/// Block by block, because a sum over rows depends on where it begins.
template <class Law, class Real>
void ColumnBody<Law, Real>::push_column(const Subdomain& s, std::int32_t slot, const StepLoad& load,
                                        ExactSum& work) {
  const std::size_t column = domain_.global_column(slot);
  const double loads[2] = {setup_.layer.bx[column], setup_.layer.by[column]};
  const double kick[2] = {load.kick * (load.pressure * loads[0] / setup_.density),
                          load.kick * (load.pressure * loads[1] / setup_.density)};
  const double path_work = load.work_pressure * setup_.time_step * setup_.lattice.volume(column);
  for (std::int32_t block = s.first_block(); block < s.past_block(); ++block) {
    const RowBlock b{slot, block};
    double space[block_rows];
    const double* __restrict share = load_.shares(b, space);
    double power[block_rows] = {};  // of the load of each row, per volume
    for (int k = 0; k < 2; ++k) {
      const auto [first, past] = free_lanes(b, k);
      double* __restrict v = v_[k].data() + domain_.first_particle(b);
      for (int lane = first; lane < past; ++lane) {
        v[lane] += kick[k] * share[lane];
        power[lane] += loads[k] * (share[lane] * v[lane]);
      }
    }
    work.add(path_work * sum_of_rows(power));
  }
}

/// The same for a pressure that follows the wall. Its work over a step is the mean of the loads at both ends
/// times the path between them: a load works on half of the path before it and half of the path after it.
template <class Law, class Real>
void ColumnBody<Law, Real>::push_deformed_column(const Subdomain& s, std::int32_t slot, const StepLoad& load,
                                                 ExactSum& work) {
  const double kick = load.kick * load.pressure / setup_.density;
  const double path_work =
      0.5 * load.pressure * setup_.time_step * setup_.lattice.volume(domain_.global_column(slot));
  const double bond_kick = load.kick * (units_.force_density(domain_.global_column(slot)) / setup_.density);
  const double path_before = first_kick_pending_ ? 0 : 1;
  for (std::int32_t block = s.first_block(); block < s.past_block(); ++block) {
    const RowBlock b{slot, block};
    double loads[3][block_rows];
    const double* __restrict share = load_.profile(b);
    follower_.load(b, bonds_, loads);
    double power[block_rows] = {};  // of the load of each row, per volume
    for (int k = 0; k < 3; ++k) {
      const auto [first, past] = free_lanes(b, k);
      const Real* __restrict sums = s.sums(static_cast<std::size_t>(k), slot, block * block_rows);
      double* __restrict v = v_[k].data() + domain_.first_particle(b);
      for (int lane = first; lane < past; ++lane) {
        const double force = share[lane] * loads[k][lane];
        const double v_before =
            v[lane] - bond_kick * static_cast<double>(sums[lane]);  // bonds have pulled already
        v[lane] += kick * force;
        power[lane] += force * (path_before * v_before + v[lane]);
      }
    }
    work.add(path_work * sum_of_rows(power));
  }
}

/// Moves a subdomain's rows of a column from t_n to t_{n+1}, under the load and the forces that the subdomain
/// has summed.
template <class Law, class Real>
void ColumnBody<Law, Real>::move_column(const Subdomain& s, std::int32_t slot, const StepLoad& load,
                                        ThreadEvents& events) {
  const std::size_t column = domain_.global_column(slot);
  const double bond_kick = load.kick * (units_.force_density(column) / setup_.density);
  const double dt = setup_.time_step;
  const std::size_t first_particle = domain_.first_particle({slot, 0});
  const auto next_u = displacement_.next();
  int too_fast = 0;
  // Loops of their own, and nothing shared between rows but a count: compilers then make vectors of them.
  for (int k = 0; k < 3; ++k) {
    const auto [first, past] = local_free_rows(s.first_row, s.past_row, k);
    const Real* __restrict force = s.sums(k, slot, 0);
    double* __restrict v = v_[k].data() + first_particle;
    for (std::int64_t row = first; row < past; ++row) v[row] += bond_kick * static_cast<double>(force[row]);
  }
  if (setup_.layer.loads(column)) {
    if (follower_.none())
      push_column(s, slot, load, events.work);
    else
      push_deformed_column(s, slot, load, events.work);
  }
  for (int k = 0; k < 3; ++k) {
    const auto [first, past] = local_free_rows(s.first_row, s.past_row, k);
    double* __restrict u = u_[k].data() + first_particle;
    const double* __restrict v = v_[k].data() + first_particle;
    Real* __restrict out = next_u[k] + domain_.padded(RowBlock{slot, 0});
    const FrameAxis axis = displacement_.frame().axis(k);
    for (std::int64_t row = first; row < past; ++row) {
      u[row] += dt * v[row];
      too_fast += std::abs(v[row]) < load.fastest ? 0 : 1;
    }
    for (std::int64_t row = first; row < past; ++row) out[row] = static_cast<Real>(axis(u[row]));
  }
  events.unstable = events.unstable || too_fast > 0;
}

template <class Law, class Real>
StepEvents ColumnBody<Law, Real>::advance(double pressure, double next_pressure) {
  load_speed_ +=
      setup_.time_step * std::abs(pressure) * load_.largest() * follower_.largest_growth() / setup_.density;
  const StepLoad load{.pressure = pressure,
                      .work_pressure = 0.5 * (pressure + next_pressure),
                      .kick = first_kick_pending_ ? 0.5 * setup_.time_step : setup_.time_step,
                      .fastest = 2 * setup_.lattice.spacing / setup_.time_step + 4 * load_speed_};
  std::vector<ThreadEvents> per_thread = make_events();
  const bool summing = !std::exchange(forces_known_, false);
  if (summing) prepare_forces(per_thread);
  for_each_subdomain([&](Subdomain& s, std::size_t thread) {
    ThreadEvents& events = per_thread[thread];
    const auto move = [&](std::int32_t slot) { move_column(s, slot, load, events); };
    if (summing) {
      forces_->template sum<false>(s, events, move);
    } else {
      for (std::int32_t slot = s.first_slot; slot < s.past_slot; ++slot) move(slot);
    }
  });
  displacement_.swap();
  first_kick_pending_ = false;
  ++steps_;

  StepEvents events;
  events.broken = std::exchange(pending_broken_, 0);
  for (ThreadEvents& t : per_thread) {
    look_for_rupture(t);
    work_.add_work(t.work);
    events.broken += t.broken;
    bonds_.count_broken(t.broken);
    events.unstable = events.unstable || t.unstable;
    damaged_ = damaged_ || t.damaged;
  }
  events.damaged = damaged_;
  if (summing) bond_evaluations_ += bonds_.intact_count();
  return events;
}

}  // namespace rhexis::peridynamics
