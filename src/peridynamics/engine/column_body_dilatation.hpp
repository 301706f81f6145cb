/// ColumnBody: what a state-based law does before forces can be summed.
#pragma once

#include "peridynamics/engine/column_body.hpp"

namespace rhexis::peridynamics {

/// Of one particle, J/m3, for its place in padded arrays.
template <class Law, class Real>
double ColumnBody<Law, Real>::dilatation_energy(double theta, std::size_t place) const {
  const double weighted_volume = Law::weighted_volume(setup_.lattice.horizon / setup_.lattice.spacing);
  return energy_scale() * local_stiffness(place) * weighted_volume * law_.dilatation_energy(theta);
}

/// Breaks bonds of a unit, then finds the dilatations and pressures of its particles.
template <class Law, class Real>
void ColumnBody<Law, Real>::dilate_unit(Unit unit, ThreadEvents& events) {
  ExtensionSums<Real> sums;
  choose_kernel([&]<bool heterogeneous, bool wrapped>() {
    sum_extensions<heterogeneous, wrapped>(law_, view(unit), sums);
  });
  note_broken(unit, sums.broken, events);

  const Lattice& lattice = setup_.lattice;
  const std::size_t column = global_column(unit.slot);
  const double per_extension =
      3 / (Law::weighted_volume(lattice.horizon / lattice.spacing) * relative_volume(column));
  double released = 0;
  for (int lane = 0; lane < domain_.rows_in(unit.block); ++lane) {
    const std::size_t place = padded_place(unit) + static_cast<std::size_t>(lane);
    const double theta = per_extension * double{sums.intact[lane]};
    state_->dilatation[particle(unit) + static_cast<std::size_t>(lane)] = theta;
    state_->pressure[place] = static_cast<Real>(0.5 * law_.kappa() * local_stiffness(place) * theta);
    if (sums.broken > 0) {
      const double before = theta + per_extension * double{sums.lost[lane]};
      released += dilatation_energy(before, place) - dilatation_energy(theta, place);
    }
  }
  events.released.add(lattice.volume(column) * released);
}

template <class Law, class Real>
void ColumnBody<Law, Real>::find_dilatations(std::vector<ThreadEvents>& per_thread) {
  const auto dilate = [&](const std::vector<Unit>& units) {
    parallel::for_each_share(threads_, units.size(), [&](int thread, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        dilate_unit(units[i], per_thread[static_cast<std::size_t>(thread)]);
    });
  };
  // The halo travels while units that do not need it are done.
  const auto u = current();
  halo_.start(u);
  dilate(interior_);
  halo_.finish(u);
  dilate(boundary_);
  for (const ThreadEvents& t : per_thread) state_->released.add(t.released);
}

}  // namespace rhexis::peridynamics
