// SPDX-License-Identifier: BSD-3-Clause
// Tubes small enough for ten thousands of steps in a second, their energy and momentum.
#pragma once

#include <numbers>

#include "support/vessels.hpp"

namespace rhexis::test {

/// Three spacings of 100 um thick, 12 rows long, with horizons of 2.3 spacings; bonds hold whatever happens.
/// Uncorrected: some of these tubes are a single ring.
inline peridynamics::Parameters small_tube(const std::string& cross_section, bool double_bonds) {
  peridynamics::Parameters p = paper_vessel(1.2e-3);
  p.inner_radius = 0.3e-3;
  p.outer_radius = 0.6e-3;
  p.horizon = 2.3e-4;
  p.cross_section = value_of<peridynamics::Arrangement>(cross_section).value();
  p.surface_correction = peridynamics::SurfaceCorrection::none;
  p.bond_precision = double_bonds ? Precision::double_precision : Precision::single_precision;
  p.ends = peridynamics::EndCondition::free;
  p.critical_stretch = 10;
  return p;
}

/// `p` with a time step of `share` of the stable one.
inline peridynamics::BodySetup setup_at(const peridynamics::Parameters& p, double share) {
  peridynamics::BodySetup setup = setup_of(p, 1);
  setup.time_step = share * stable_step_of(setup);
  return setup;
}

inline double energy(peridynamics::Body& body) {
  body.observe(0);
  const peridynamics::Totals t = body.totals();
  return t.kinetic + t.strain + t.fracture;
}

/// Tells the body that a load gave it the state it is in, one that moves loose particles at `speed` (m/s).
inline void allow_speed(peridynamics::Body& body, double speed) {
  peridynamics::Body::Saved saved = body.save();
  saved.load_speed = speed;
  body.restore(saved);
}

/// Flattens the cross-section by `amount`, the start of a tube's slowest vibration.
inline auto flattened(double amount) {
  return [amount](const std::array<double, 3>& x) { return std::array{amount * x[0], -amount * x[1], 0.0}; };
}

}  // namespace rhexis::test
