// SPDX-License-Identifier: BSD-3-Clause
/// ColumnBody: fields and totals at one moment.
#pragma once

#include <limits>

#include "peridynamics/engine/column_body.hpp"

namespace rhexis::peridynamics {

template <class Law, class Real>
void ColumnBody<Law, Real>::find_forces(double /*pressure*/) {
  if (std::exchange(forces_known_, true)) return;
  std::vector<ThreadEvents> per_thread = make_events();
  prepare_forces(per_thread);
  for_each_subdomain([&](Subdomain& s, std::size_t thread) {
    forces_->template sum<true>(s, per_thread[thread], [](std::int32_t) {});
  });
  crushed_ = 0;
  for (ThreadEvents& t : per_thread) {
    look_for_rupture(t);
    damaged_ = damaged_ || t.damaged;
    crushed_ += t.crushed;
    bonds_.count_broken(t.broken);
    pending_broken_ += t.broken;
  }
  bond_evaluations_ += bonds_.intact_count();
}

/// Fills velocity and force density of a block; returns the sum of its squared speeds, m2/s2.
template <class Law, class Real>
double ColumnBody<Law, Real>::observe_motion(const Subdomain& s, RowBlock b, double pressure, double kick) {
  const std::size_t column = domain_.global_column(b.slot);
  const double force_unit = units_.force_density(column);
  const double dead[3] = {setup_.layer.bx[column], setup_.layer.by[column], 0.0};
  const bool is_dead = follower_.none() || !setup_.layer.loads(column);
  double loads[3][block_rows], space[block_rows];
  for (int k = 0; k < 3; ++k) std::fill_n(loads[k], block_rows, dead[k]);
  if (!is_dead) follower_.load(b, bonds_, loads);
  const double* const share = is_dead ? load_.shares(b, space) : load_.profile(b);
  const std::size_t first = domain_.first_particle(b);
  double speed2 = 0;
  for (int k = 0; k < 3; ++k) {
    const auto [first_free, past_free] = free_lanes(b, k);
    const Real* const sums = s.sums(static_cast<std::size_t>(k), b.slot, b.block * block_rows);
    for (int lane = 0; lane < domain_.rows_in(b.block); ++lane) {
      const double force =
          force_unit * static_cast<double>(sums[lane]) + share[lane] * (pressure * loads[k][lane]);
      const bool moves = lane >= first_free && lane < past_free;
      const double v = v_[k][first + lane] + (moves ? kick * force / setup_.density : 0.0);
      observation_.force_density[k][first + lane] = force;
      observation_.velocity[k][first + lane] = v;
      speed2 += v * v;
    }
  }
  return speed2;
}

/// Work (J) of a pressure that follows the wall on half of the path before the present moment, which the next
/// step will add to the account (push_deformed_column).
template <class Law, class Real>
double ColumnBody<Law, Real>::work_of_half_step(RowBlock b, double pressure) {
  const std::size_t column = domain_.global_column(b.slot);
  if (follower_.none() || !setup_.layer.loads(column) || first_kick_pending_) return 0;
  double loads[3][block_rows];
  const double* const share = load_.profile(b);
  follower_.load(b, bonds_, loads);
  double power = 0;
  for (int k = 0; k < 3; ++k) {
    const auto [first, past] = free_lanes(b, k);
    const double* const v = v_[k].data() + domain_.first_particle(b);
    for (int lane = first; lane < past; ++lane) power += share[lane] * loads[k][lane] * v[lane];
  }
  return 0.5 * pressure * setup_.time_step * setup_.lattice.volume(column) * power;
}

/// Fills the observed fields of a block and adds to the sums.
template <class Law, class Real>
void ColumnBody<Law, Real>::observe_block(const Subdomain& s, RowBlock b, double pressure, double kick,
                                          ObservedSums& sums) {
  const std::size_t column = domain_.global_column(b.slot);
  const double energy_unit = 0.5 * units_.energy_density() / units_.relative_volume(column);
  const double particle_volume = setup_.lattice.volume(column);
  const std::size_t first = domain_.first_particle(b);
  const int rows = domain_.rows_in(b.block);
  const double speed2 = observe_motion(s, b, pressure, kick);

  double* const damage = observation_.damage.data() + first;
  if (bonds_.take_changed(b)) {
    double found[block_rows];
    bonds_.find_damage(b, found);
    for (int lane = 0; lane < rows; ++lane) {
      const bool absent = properties_.is_absent(domain_.padded(b) + static_cast<std::size_t>(lane));
      damage[lane] = absent ? std::numeric_limits<double>::quiet_NaN() : found[lane];
    }
    fracture_.find(b);
  }
  const Real* const energies = s.sums(3, b.slot, b.block * block_rows);
  double strain = 0;
  for (int lane = 0; lane < rows; ++lane) {
    double energy = energy_unit * static_cast<double>(energies[lane]);
    if constexpr (Law::state_based) energy += dilatation_->energy_density(b, lane, properties_);
    observation_.strain_energy_density[first + static_cast<std::size_t>(lane)] = energy;
    strain += energy;
    sums.max_damage = std::max(sums.max_damage, damage[lane]);  // ignores absent particles: not a number
    if (damage[lane] >= rupture_damage) {
      const std::int64_t row = domain_.layout().first_row + b.block * block_rows + lane;
      sums.ruptured_first = std::min(sums.ruptured_first, row);
      sums.ruptured_last = std::max(sums.ruptured_last, row);
    }
  }
  sums.kinetic.add(0.5 * setup_.density * particle_volume * speed2);
  sums.strain.add(particle_volume * strain);
  sums.half_step_work.add(work_of_half_step(b, pressure));
  if (const double fracture = fracture_.of(b); fracture > 0) sums.fracture.add(fracture);
}

template <class Law, class Real>
const Observation& ColumnBody<Law, Real>::observe(double pressure) {
  for (int k = 0; k < 3; ++k) {
    observation_.velocity[k].resize(particles());
    observation_.force_density[k].resize(particles());
  }
  observation_.strain_energy_density.resize(particles());
  observation_.damage.resize(particles());

  find_forces(pressure);
  const double kick = first_kick_pending_ ? 0.0 : 0.5 * setup_.time_step;
  std::vector<ObservedSums> per_thread(static_cast<std::size_t>(threads_), ObservedSums(setup_.energy_scale));
  for_each_subdomain([&](const Subdomain& s, std::size_t thread) {
    for (std::int32_t slot = s.first_slot; slot < s.past_slot; ++slot) {
      for (std::int32_t block = s.first_block(); block < s.past_block(); ++block)
        observe_block(s, {slot, block}, pressure, kick, per_thread[thread]);
    }
  });
  observed_ = per_thread.front();
  for (std::size_t t = 1; t < per_thread.size(); ++t) observed_.add(per_thread[t]);
  damaged_ = damaged_ || observed_.max_damage >= rupture_damage;
  return observation_;
}

template <class Law, class Real>
Totals ColumnBody<Law, Real>::totals() const {
  Totals totals;
  totals.kinetic = observed_.kinetic.value(comm_);
  totals.strain = observed_.strain.value(comm_);
  totals.fracture = observed_.fracture.value(comm_);
  if constexpr (Law::state_based) totals.fracture += work_.released(comm_);
  totals.external_work = work_.work(comm_) + observed_.half_step_work.value(comm_);
  totals.lost = work_.lost();
  totals.max_displacement = max_displacement();
  totals.max_damage = comm_.all_reduce(observed_.max_damage, parallel::Reduce::max);
  const std::int64_t broken = bonds_.initial_count() - bonds_.intact_count();
  totals.broken_bonds = comm_.all_reduce(broken, parallel::Reduce::sum) / 2;
  totals.crushed_bonds = comm_.all_reduce(crushed_, parallel::Reduce::sum) / 2;
  const std::int64_t first = comm_.all_reduce(observed_.ruptured_first, parallel::Reduce::min);
  const std::int64_t last = comm_.all_reduce(observed_.ruptured_last, parallel::Reduce::max);
  if (last >= first)
    totals.rupture_length = static_cast<double>(last - first + 1) * setup_.lattice.row_spacing;
  return totals;
}

template <class Law, class Real>
std::vector<double> ColumnBody<Law, Real>::volumes() const {
  const ColumnLayout& l = domain_.layout();
  std::vector<double> volumes;
  volumes.reserve(particles());
  for (std::int64_t c = 0; c < l.column_count; ++c) {
    volumes.insert(volumes.end(), static_cast<std::size_t>(l.row_count),
                   setup_.lattice.volume(static_cast<std::size_t>(l.first_column + c)));
  }
  return volumes;
}

template <class Law, class Real>
void ColumnBody<Law, Real>::clear_held(std::array<std::vector<double>, 3>& field) const {
  const ColumnLayout& l = domain_.layout();
  for (int k = 0; k < 3; ++k) {
    const auto [first_free, past_free] = local_free_rows(0, l.row_count, k);
    for (std::int64_t c = 0; c < l.column_count; ++c) {
      const auto column = field[static_cast<std::size_t>(k)].begin() + c * l.row_count;
      std::fill(column, column + first_free, 0.0);
      std::fill(column + past_free, column + l.row_count, 0.0);
    }
  }
}

template <class Law, class Real>
double ColumnBody<Law, Real>::max_displacement() const {
  std::vector<double> largest(static_cast<std::size_t>(threads_));
  parallel::for_each_share(threads_, particles(), [&](int thread, std::size_t begin, std::size_t end) {
    double& mine = largest[static_cast<std::size_t>(thread)];
    for (std::size_t i = begin; i < end; ++i)
      mine = std::max(mine, u_[0][i] * u_[0][i] + u_[1][i] * u_[1][i] + u_[2][i] * u_[2][i]);
  });
  return std::sqrt(comm_.all_reduce(*std::ranges::max_element(largest), parallel::Reduce::max));
}

}  // namespace rhexis::peridynamics
