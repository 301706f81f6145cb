/// ColumnBody: one step in time.
#pragma once

#include "peridynamics/engine/column_body.hpp"

namespace rhexis::peridynamics {

template <class Law, class Real>
BlockView<Real> ColumnBody<Law, Real>::view(std::int32_t slot, std::int64_t row, std::uint16_t* words) {
  const std::size_t place = domain_.padded(static_cast<std::size_t>(slot)) + static_cast<std::size_t>(row);
  const auto u = current();
  BlockView<Real> block{.u = {u[0] + place, u[1] + place, u[2] + place},
                        .bonds = bonds_of({slot, 0}),
                        .intact = words,
                        .breaking_t = static_cast<Real>(Law::breaking_t(setup_.critical_stretch))};
  if constexpr (Law::state_based) block.pressure = state_->pressure.data() + place;
  if (!half_stretch_.empty()) block.local = {half_stretch_.data() + place, half_stiffness_.data() + place};
  return block;
}

template <class Law, class Real>
BlockView<Real> ColumnBody<Law, Real>::view(Part<Real>& part, std::int32_t slot, std::int64_t row,
                                            std::uint16_t* words) {
  BlockView<Real> block = view(slot, row, words);
  const std::size_t place =
      domain_.padded(static_cast<std::size_t>(slot - part.first_slot)) + static_cast<std::size_t>(row);
  for (std::size_t k = 0; k < 4; ++k) block.sums[k] = part.sums[k].get() + place;
  block.broken = part.broken.data();
  return block;
}

/// Calls `use` for the kernel that the wall needs, with flags heterogeneous and wrapped.
template <class Law, class Real>
template <class Use>
void ColumnBody<Law, Real>::choose_kernel(const Use& use) const {
  const bool wrapped = per_period_ > 0;
  if (half_stretch_.empty()) {
    wrapped ? use.template operator()<false, true>() : use.template operator()<false, false>();
  } else {
    wrapped ? use.template operator()<true, true>() : use.template operator()<true, false>();
  }
}

template <class Law, class Real>
template <bool observing>
BlockEvents ColumnBody<Law, Real>::sum(const BlockView<Real>& block, std::span<const BondRun> runs) const {
  BlockEvents events;
  choose_kernel([&]<bool heterogeneous, bool wrapped>() {
    sum_block<observing, heterogeneous, wrapped>(law_, block, runs, events);
  });
  return events;
}

/// Of owned rows [begin, past): those whose motion along axis `component` the ends do not hold.
template <class Law, class Real>
std::pair<std::int64_t, std::int64_t> ColumnBody<Law, Real>::free_rows(std::int64_t begin, std::int64_t past,
                                                                       int component) const {
  const std::pair<std::int64_t, std::int64_t>& free = free_rows_[static_cast<std::size_t>(component)];
  const std::int64_t first_row = domain_.layout().first_row;
  return {std::clamp(free.first - first_row, begin, past), std::clamp(free.second - first_row, begin, past)};
}

/// The same of a unit's rows, counted from its first.
template <class Law, class Real>
std::pair<int, int> ColumnBody<Law, Real>::free_rows(Unit unit, int component) const {
  const std::int64_t begin = unit.block * block_rows;
  const auto [first, past] = free_rows(begin, begin + domain_.rows_in(unit.block), component);
  return {static_cast<int>(first - begin), static_cast<int>(past - begin)};
}

/// Rows in which bond `b` of a unit was born and is broken.
template <class Law, class Real>
std::uint16_t ColumnBody<Law, Real>::broken(Unit unit, std::size_t b) const {
  const std::uint16_t word = intact_[first_word(unit) + b];
  constexpr std::uint16_t all = 0xFFFF;
  return word == all ? std::uint16_t{0} : static_cast<std::uint16_t>(born(unit, b) & ~word);
}

/// Eq. (6) of each row: the share of its family's volume that it is no longer bonded to; 0 for a particle
/// that was born without bonds.
template <class Law, class Real>
void ColumnBody<Law, Real>::find_damage(Unit unit, double (&damage)[block_rows]) const {
  std::fill_n(damage, block_rows, 0.0);
  const auto bonds = bonds_of(unit);
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    const unsigned rows = broken(unit, b);
    if (rows == 0) continue;
    const double volume = bonds[b].volume;
    for (int lane = 0; lane < block_rows; ++lane) damage[lane] += (rows >> lane & 1u) ? volume : 0.0;
  }
  const double* whole = family_volume_.data() + particle(unit);
  for (int lane = 0; lane < domain_.rows_in(unit.block); ++lane)
    damage[lane] = whole[lane] > 0 ? damage[lane] / whole[lane] : 0;
}

/// Damage reaches `rupture_damage` somewhere in the unit.
template <class Law, class Real>
bool ColumnBody<Law, Real>::has_ruptured(Unit unit) const {
  double damage[block_rows];
  find_damage(unit, damage);
  return *std::max_element(damage, damage + domain_.rows_in(unit.block)) >= rupture_damage;
}

template <class Law, class Real>
void ColumnBody<Law, Real>::note_broken(Unit unit, int broken, ThreadEvents& events) {
  if (broken == 0) return;
  events.broken += broken;
  events.broken_units.push_back(unit);
  changed_[number(unit)] = 1;
}

/// Once all bonds of the units are broken that are due.
template <class Law, class Real>
void ColumnBody<Law, Real>::look_for_rupture(ThreadEvents& events) const {
  for (const Unit unit : events.broken_units) {
    if (!damaged_ && !events.damaged) events.damaged = has_ruptured(unit);
  }
  events.broken_units.clear();
}

/// What forces need: a frame that followed the body, a state-based law's dilatations, the halo.
template <class Law, class Real>
void ColumnBody<Law, Real>::prepare_forces(std::vector<ThreadEvents>& per_thread) {
  if (steps_ % frame_interval == 0) follow_body();
  if constexpr (Law::state_based) {
    find_dilatations(per_thread);
    Real* const pressure = state_->pressure.data();
    const std::span<Real* const> field(&pressure, 1);
    state_->halo.start(field);
    state_->halo.finish(field);
  } else {
    const auto u = current();
    halo_.start(u);
    halo_.finish(u);
  }
}

/// In an order that compilers find vectors in.
inline double sum_of_rows(const double (&row)[block_rows]) {
  static_assert(block_rows == 16);
  double eight[8], four[4];
  for (int i = 0; i < 8; ++i) eight[i] = row[i] + row[i + 8];
  for (int i = 0; i < 4; ++i) four[i] = eight[i] + eight[i + 4];
  return (four[0] + four[2]) + (four[1] + four[3]);
}

/// Adds the load to the velocity of a part's rows of a column, and its work over the step to `work`. Block by
/// block, for a sum over rows depends on where it begins.
template <class Law, class Real>
void ColumnBody<Law, Real>::push_column(const Part<Real>& part, std::int32_t slot, const Push& push,
                                        ExactSum& work) {
  const std::size_t column = global_column(slot);
  const double loads[2] = {setup_.layer.bx[column], setup_.layer.by[column]};
  const double kick[2] = {push.kick * (push.pressure * loads[0] / setup_.density),
                          push.kick * (push.pressure * loads[1] / setup_.density)};
  const double path_work = push.work_pressure * setup_.time_step * setup_.lattice.volume(column);
  for (std::int32_t block = part.first_block(); block < part.past_block(); ++block) {
    const Unit unit{slot, block};
    double space[block_rows];
    const double* __restrict share = load_shares(unit, space);
    double power[block_rows] = {};  // of the load of each row, per volume
    for (int k = 0; k < 2; ++k) {
      const auto [first, past] = free_rows(unit, k);
      double* __restrict v = v_[k].data() + particle(unit);
      for (int lane = first; lane < past; ++lane) {
        v[lane] += kick[k] * share[lane];
        power[lane] += loads[k] * (share[lane] * v[lane]);
      }
    }
    work.add(path_work * sum_of_rows(power));
  }
}

/// A part's rows of a column from t_n to t_{n+1} under the load and the forces that the part has summed.
template <class Law, class Real>
void ColumnBody<Law, Real>::move_column(const Part<Real>& part, std::int32_t slot, const Push& push,
                                        ThreadEvents& events) {
  const std::size_t column = global_column(slot);
  const double bond_kick = push.kick * (bond_force_density(column) / setup_.density);
  const double dt = setup_.time_step;
  const std::size_t first_particle = particle({slot, 0});
  const std::size_t place = padded_place({slot, 0});
  const std::size_t place_in_part = padded_place({slot - part.first_slot, 0});
  const auto next_u = next();
  int too_fast = 0;
  // Loops of their own and nothing shared between rows but a count: compilers then make vectors of them.
  for (int k = 0; k < 3; ++k) {
    const auto [first, past] = free_rows(part.first_row, part.past_row, k);
    const Real* __restrict force = part.sums[k].get() + place_in_part;
    double* __restrict v = v_[k].data() + first_particle;
    for (std::int64_t row = first; row < past; ++row) v[row] += bond_kick * static_cast<double>(force[row]);
  }
  if (setup_.layer.loads(column)) push_column(part, slot, push, events.work);
  for (int k = 0; k < 3; ++k) {
    const auto [first, past] = free_rows(part.first_row, part.past_row, k);
    double* __restrict u = u_[k].data() + first_particle;
    const double* __restrict v = v_[k].data() + first_particle;
    Real* __restrict out = next_u[k] + place;
    const double frame = frame_[k];
    for (std::int64_t row = first; row < past; ++row) {
      u[row] += dt * v[row];
      too_fast += std::abs(v[row]) < push.fastest ? 0 : 1;
    }
    for (std::int64_t row = first; row < past; ++row) out[row] = in_frame(u[row], frame);
  }
  events.unstable = events.unstable || too_fast > 0;
}

template <class Law, class Real>
StepEvents ColumnBody<Law, Real>::advance(double pressure, double next_pressure) {
  const double kick = first_kick_pending_ ? 0.5 * setup_.time_step : setup_.time_step;
  load_speed_ += setup_.time_step * std::abs(pressure) * largest_load_ / setup_.density;
  const Push push{.pressure = pressure,
                  .work_pressure = 0.5 * (pressure + next_pressure),
                  .kick = kick,
                  .fastest = 2 * setup_.lattice.spacing / setup_.time_step + 4 * load_speed_};
  std::vector<ThreadEvents> per_thread(static_cast<std::size_t>(threads_), ThreadEvents(setup_.energy_scale));
  const bool summing = !std::exchange(forces_known_, false);
  if (summing) prepare_forces(per_thread);
  parallel::for_each_share(threads_, parts_.size(), [&](int thread, std::size_t begin, std::size_t end) {
    ThreadEvents& events = per_thread[static_cast<std::size_t>(thread)];
    for (std::size_t p = begin; p < end; ++p) {
      Part<Real>& part = parts_[p];
      const auto move = [&](std::int32_t slot) { move_column(part, slot, push, events); };
      if (summing) {
        sum_part<false>(part, events, move);
      } else {
        for (std::int32_t slot = part.first_slot; slot < part.past_slot; ++slot) move(slot);
      }
    }
    look_for_rupture(events);
  });
  now_ = 1 - now_;
  first_kick_pending_ = false;
  ++steps_;

  StepEvents events;
  events.broken = std::exchange(pending_broken_, 0);
  for (const ThreadEvents& t : per_thread) {
    work_.add(t.work);
    events.broken += t.broken;
    intact_directed_ -= t.broken;
    events.unstable = events.unstable || t.unstable;
    damaged_ = damaged_ || t.damaged;
  }
  events.damaged = damaged_;
  if (summing) bond_evaluations_ += intact_directed_;
  return events;
}

}  // namespace rhexis::peridynamics
