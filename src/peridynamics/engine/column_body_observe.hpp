/// ColumnBody: fields and totals at one moment.
#pragma once

#include <limits>

#include "peridynamics/engine/column_body.hpp"

namespace rhexis::peridynamics {

/// What it took to break one bond of the unit in the rows of `broken`, in units of a uniform PMB wall's.
template <class Law, class Real>
double ColumnBody<Law, Real>::breaking_energy(Unit unit, const BondConstants<Real>& bond,
                                              std::uint16_t broken) const {
  if (half_stretch_.empty()) return std::popcount(broken) * law_.energy_ratio(setup_.critical_stretch);
  const std::size_t here = padded_place(unit),
                    there = here + static_cast<std::size_t>(std::int64_t{bond.offset});
  double energy = 0;
  for (int rows = broken; rows != 0; rows &= rows - 1) {
    const auto row = static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(rows)));
    const double s = double{half_stretch_[here + row]} + double{half_stretch_[there + row]};
    const double in_uniform = s / setup_.critical_stretch;
    energy += in_uniform * in_uniform * law_.energy_ratio(s) *
              (double{half_stiffness_[here + row]} + double{half_stiffness_[there + row]});
  }
  return energy;
}

/// J, this unit's half of what its broken bonds took: c s0^2 |xi| V_i V_j / 2 each (PMB).
template <class Law, class Real>
double ColumnBody<Law, Real>::fracture_energy(Unit unit) const {
  const double s0 = setup_.critical_stretch;
  const double spacing = setup_.lattice.spacing;
  const double per_weight = 0.25 * energy_scale() * s0 * s0 * (spacing * spacing * spacing);
  const auto bonds = bonds_of(unit);
  double fracture = 0;
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    if (const std::uint16_t rows = broken(unit, b); rows != 0)
      fracture += breaking_energy(unit, bonds[b], rows) * double{bonds[b].energy_weight};
  }
  return per_weight * fracture;
}

template <class Law, class Real>
void ColumnBody<Law, Real>::observe_unit(const Part<Real>& part, Unit unit, double pressure, double kick,
                                         ThreadTotals& totals) {
  const std::size_t column = global_column(unit.slot);
  const Lattice& lattice = setup_.lattice;
  const double force_scale = bond_force_density(column);
  const double energy_scale = 0.5 * this->energy_scale() / relative_volume(column);
  const double particle_volume = lattice.volume(column);
  const double load[3] = {pressure * setup_.layer.bx[column], pressure * setup_.layer.by[column], 0.0};
  double space[block_rows];
  const double* share = load_shares(unit, space);
  const std::size_t first = particle(unit);
  const std::size_t in_part = padded_place({unit.slot - part.first_slot, unit.block});
  const int rows = domain_.rows_in(unit.block);

  double speed2 = 0, strain = 0;
  for (int k = 0; k < 3; ++k) {
    const auto [first_free, past_free] = free_rows(unit, k);
    const Real* const sums = part.sums[k].get() + in_part;
    for (int lane = 0; lane < rows; ++lane) {
      const double force = force_scale * static_cast<double>(sums[lane]) + share[lane] * load[k];
      const bool moves = lane >= first_free && lane < past_free;
      const double v = v_[k][first + lane] + (moves ? kick * force / setup_.density : 0.0);
      observation_.force_density[k][first + lane] = force;
      observation_.velocity[k][first + lane] = v;
      speed2 += v * v;
    }
  }
  double* const damage = observation_.damage.data() + first;
  if (std::exchange(changed_[number(unit)], char{0})) {
    double damage_of[block_rows];
    find_damage(unit, damage_of);
    for (int lane = 0; lane < rows; ++lane)
      damage[lane] = is_absent(unit, lane) ? std::numeric_limits<double>::quiet_NaN() : damage_of[lane];
    fracture_energy_[number(unit)] = fracture_energy(unit);
  }
  const Real* const energies = part.sums[3].get() + in_part;
  for (int lane = 0; lane < rows; ++lane) {
    double energy = energy_scale * static_cast<double>(energies[lane]);
    if constexpr (Law::state_based) {
      energy += dilatation_energy(state_->dilatation[first + lane], padded_place(unit) + lane);
    }
    observation_.strain_energy_density[first + lane] = energy;
    strain += energy;
    totals.max_damage = std::max(totals.max_damage, damage[lane]);  // of absent particles: not a number
    if (damage[lane] >= rupture_damage) {
      const std::int64_t row = domain_.layout().first_row + unit.block * block_rows + lane;
      totals.ruptured_first = std::min(totals.ruptured_first, row);
      totals.ruptured_last = std::max(totals.ruptured_last, row);
    }
  }
  totals.kinetic.add(0.5 * setup_.density * particle_volume * speed2);
  totals.strain.add(particle_volume * strain);
  if (const double fracture = fracture_energy_[number(unit)]; fracture > 0) totals.fracture.add(fracture);
}

template <class Law, class Real>
void ColumnBody<Law, Real>::find_forces() {
  if (std::exchange(forces_known_, true)) return;
  std::vector<ThreadEvents> per_thread(static_cast<std::size_t>(threads_), ThreadEvents(setup_.energy_scale));
  prepare_forces(per_thread);
  parallel::for_each_share(threads_, parts_.size(), [&](int thread, std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      sum_part<true>(parts_[p], per_thread[static_cast<std::size_t>(thread)], [](std::int32_t) {});
  });
  crushed_ = 0;
  for (ThreadEvents& t : per_thread) {
    look_for_rupture(t);
    damaged_ = damaged_ || t.damaged;
    crushed_ += t.crushed;
    intact_directed_ -= t.broken;
    pending_broken_ += t.broken;
  }
  bond_evaluations_ += intact_directed_;
}

template <class Law, class Real>
const Observation& ColumnBody<Law, Real>::observe(double pressure) {
  const std::size_t particles = u_[0].size();
  for (int k = 0; k < 3; ++k) {
    observation_.velocity[k].resize(particles);
    observation_.force_density[k].resize(particles);
  }
  observation_.strain_energy_density.resize(particles);
  observation_.damage.resize(particles);

  find_forces();
  const double kick = first_kick_pending_ ? 0.0 : 0.5 * setup_.time_step;
  std::vector<ThreadTotals> per_thread(static_cast<std::size_t>(threads_), ThreadTotals(setup_.energy_scale));
  parallel::for_each_share(threads_, parts_.size(), [&](int thread, std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Part<Real>& part = parts_[p];
      for (std::int32_t slot = part.first_slot; slot < part.past_slot; ++slot) {
        for (std::int32_t block = part.first_block(); block < part.past_block(); ++block)
          observe_unit(part, {slot, block}, pressure, kick, per_thread[static_cast<std::size_t>(thread)]);
      }
    }
  });
  observed_ = per_thread.front();
  for (std::size_t t = 1; t < per_thread.size(); ++t) {
    const ThreadTotals& other = per_thread[t];
    observed_.kinetic.add(other.kinetic);
    observed_.strain.add(other.strain);
    observed_.fracture.add(other.fracture);
    observed_.max_damage = std::max(observed_.max_damage, other.max_damage);
    observed_.ruptured_first = std::min(observed_.ruptured_first, other.ruptured_first);
    observed_.ruptured_last = std::max(observed_.ruptured_last, other.ruptured_last);
  }
  damaged_ = damaged_ || observed_.max_damage >= rupture_damage;
  return observation_;
}

template <class Law, class Real>
Totals ColumnBody<Law, Real>::totals() const {
  Totals totals;
  totals.kinetic = observed_.kinetic.value(comm_);
  totals.strain = observed_.strain.value(comm_);
  totals.fracture = observed_.fracture.value(comm_);
  if constexpr (Law::state_based) totals.fracture += state_->released.value(comm_);
  totals.external_work = work_.value(comm_);
  totals.lost = std::ldexp(setup_.energy_scale, -40);  // a quantum of 2^-80 for each of 2^40 terms
  totals.max_displacement = max_displacement();
  totals.max_damage = comm_.all_reduce(observed_.max_damage, parallel::Reduce::max);
  totals.broken_bonds = comm_.all_reduce(born_directed_ - intact_directed_, parallel::Reduce::sum) / 2;
  totals.crushed_bonds = comm_.all_reduce(crushed_, parallel::Reduce::sum) / 2;
  const std::int64_t first = comm_.all_reduce(observed_.ruptured_first, parallel::Reduce::min);
  const std::int64_t last = comm_.all_reduce(observed_.ruptured_last, parallel::Reduce::max);
  if (last >= first)
    totals.rupture_length = static_cast<double>(last - first + 1) * setup_.lattice.row_spacing;
  return totals;
}

template <class Law, class Real>
double ColumnBody<Law, Real>::max_displacement() const {
  std::vector<double> largest(static_cast<std::size_t>(threads_));
  parallel::for_each_share(threads_, u_[0].size(), [&](int thread, std::size_t begin, std::size_t end) {
    double& mine = largest[static_cast<std::size_t>(thread)];
    for (std::size_t i = begin; i < end; ++i)
      mine = std::max(mine, u_[0][i] * u_[0][i] + u_[1][i] * u_[1][i] + u_[2][i] * u_[2][i]);
  });
  return std::sqrt(comm_.all_reduce(*std::ranges::max_element(largest), parallel::Reduce::max));
}

}  // namespace rhexis::peridynamics
