// SPDX-License-Identifier: BSD-3-Clause
#include "studies/rupture/history_observer.hpp"

#include <algorithm>

namespace rhexis::studies {

bool HistoryObserver::wants(const Moment& moment) {
  return moment.last || std::ranges::binary_search(steps_, moment.step);
}

void HistoryObserver::observe(const Moment& moment) {
  const peridynamics::Totals& t = simulation_.totals();
  const double open_area = simulation_.open_area();
  history_.append({.step = moment.step,
                   .time_s = moment.time_s,
                   .pressure_Pa = simulation_.pressure(),
                   .max_displacement_m = t.max_displacement,
                   .max_damage = t.max_damage,
                   .broken_bonds = static_cast<long>(t.broken_bonds),
                   .kinetic_J = t.kinetic,
                   .strain_J = t.strain,
                   .external_work_J = t.external_work,
                   .rupture_length_m = t.rupture_length,
                   .leak_m3_s = load_.leak(simulation_),
                   .fracture_J = t.fracture,
                   .opening_m2 = open_area});
}

}  // namespace rhexis::studies
