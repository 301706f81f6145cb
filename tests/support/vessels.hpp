// SPDX-License-Identifier: BSD-3-Clause
// Vessels and bodies for tests.
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "parallel/communicator.hpp"
#include "peridynamics/bonds/surface_correction.hpp"
#include "peridynamics/engine/body.hpp"
#include "peridynamics/laws/pmb.hpp"
#include "peridynamics/parameters.hpp"
#include "peridynamics/stability/bond_step.hpp"

namespace rhexis::test {

inline parallel::Communicator self() {
  return parallel::Communicator(MPI_COMM_SELF);
}

/// The paper's wall (Table 2), `length` m long, resolved.
inline peridynamics::Parameters paper_vessel(double length = 2e-3) {
  peridynamics::Parameters p;
  p.inner_radius = 1.5e-3;
  p.outer_radius = 2e-3;
  p.length = length;
  p.density = 1300;
  p.young_modulus = 3.5e6;
  p.critical_stretch = 0.25;
  p.cross_section = peridynamics::Arrangement::lattice;
  p.surface_correction = peridynamics::SurfaceCorrection::automatic;
  p.spacing = 1e-4;
  p.horizon = 3.5e-4;
  p.lattice_shift = {0.5, 0.5};
  p.bond_precision = Precision::single_precision;
  p.ends = peridynamics::EndCondition::clamped;
  p.pressure = 238e3;
  p.schedule = peridynamics::Schedule::ramp;
  p.direction = peridynamics::LoadDirection::dead;
  p.layer = peridynamics::LayerForce::paper;
  p.venting = peridynamics::Venting::none;
  p.end_time = 2.25e-3;
  return p;
}

/// An endless piece of that wall with `across` spacings across it and a horizon of `ratio` spacings;
/// unresolved.
inline peridynamics::Parameters endless_vessel(const std::string& cross_section,
                                               const std::string& correction, const std::string& layer,
                                               double across, double ratio) {
  peridynamics::Parameters p = paper_vessel();
  p.cross_section = value_of<peridynamics::Arrangement>(cross_section).value();
  p.surface_correction = value_of<peridynamics::SurfaceCorrection>(correction).value();
  p.layer = value_of<peridynamics::LayerForce>(layer).value();
  p.spacing = (p.outer_radius - p.inner_radius) / across;
  p.horizon = ratio * *p.spacing;
  p.length = 16 * *p.spacing;
  p.ends = peridynamics::EndCondition::axial_periodic;
  return p;
}

inline peridynamics::BodySetup setup_of(peridynamics::Parameters p, double time_step) {
  peridynamics::resolve(p);
  peridynamics::Lattice lattice = peridynamics::make_lattice(p);
  peridynamics::SharedFamilies families = peridynamics::shared_families(p, lattice);
  return peridynamics::make_setup(p, std::move(lattice), std::move(families), time_step);
}

/// Two particles one spacing (1 m) apart along x, of 1 m3 and 1 kg each, with c = 1; no load.
inline peridynamics::BodySetup two_particles(bool doubles, double critical_stretch, double time_step) {
  peridynamics::BodySetup s;
  s.lattice = {{{0.0, 1.0}, {0.0, 0.0}, {1.0, 1.0}}, 1, 1.0, 1.0, 1.5};
  s.families = std::make_shared<const peridynamics::BondFamilies>(find_families(s.lattice));
  s.layer = {{0.0, 0.0}, {0.0, 0.0}};
  s.density = 1;
  s.bond_constant = 1;
  s.critical_stretch = critical_stretch;
  s.time_step = time_step;
  s.energy_scale = 1;
  s.double_bonds = doubles;
  return s;
}

inline double stable_step_of(const peridynamics::BodySetup& s) {
  return peridynamics::stable_bond_step(s.lattice, *s.families, s.bond_constant, s.density,
                                        s.critical_stretch);
}

/// A state given by functions of the reference position.
template <class Function>
std::array<std::vector<double>, 3> sample(const peridynamics::Body& body, const Function& function) {
  std::array<std::vector<double>, 3> values;
  const auto particles = static_cast<std::size_t>(body.ids().local_count());
  for (std::size_t i = 0; i < particles; ++i) {
    const std::array<double, 3> v = function(body.reference_position(i));
    for (std::size_t k = 0; k < 3; ++k) values[k].push_back(v[k]);
  }
  return values;
}

/// Wild enough to break some bonds at a critical stretch of 0.05.
inline auto wild(double spacing) {
  return [a = 0.1 * spacing](const std::array<double, 3>& x) {
    return std::array{a * std::sin(9e4 * x[1]), a * std::sin(5e4 * x[2]), a * std::sin(7e4 * x[0])};
  };
}

inline std::array<double, 3> nothing(const std::array<double, 3>&) {
  return {0, 0, 0};
}

/// The energy that leapfrog conserves, to fourth order in the step, of an unloaded body with no held rows one
/// step on; goes two steps. The usual energy swings about it by (omega dt)^2 of each mode's share, and goes
/// with it where modes of other frequencies take the energy over. Hairer, Lubich & Wanner 2003, Acta Numer.
/// 12, Sec. 3: H + dt^2 (v . U'' v / 12 - m a^2 / 24), U'' v from the forces a step before and after.
inline double shadow_energy(peridynamics::Body& body, const peridynamics::BodySetup& setup) {
  const auto before = body.observe(0).force_density;
  body.advance(0, 0);
  const peridynamics::Observation now = body.observe(0);
  const peridynamics::Totals t = body.totals();
  body.advance(0, 0);
  const auto& after = body.observe(0).force_density;
  const auto rows = static_cast<std::size_t>(body.columns()->row_count);
  const double dt = setup.time_step;
  double terms = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < after[k].size(); ++i) {
      const double force = now.force_density[k][i], change = after[k][i] - before[k][i];
      terms +=
          setup.lattice.volume(i / rows) * (dt * force * force / setup.density + now.velocity[k][i] * change);
    }
  }
  return t.kinetic + t.strain + t.fracture - dt / 24 * terms;
}

/// Dynamic relaxation: velocities are dropped whenever the kinetic energy has passed a peak. Observes at the
/// end.
inline void bring_to_rest(peridynamics::Body& body, double pressure, int steps) {
  const auto still = sample(body, nothing);
  double before = 0;
  for (int i = 0; i < steps; ++i) {
    body.advance(pressure, pressure);
    if (i % 5 != 0) continue;
    body.observe(pressure);
    const double kinetic = body.totals().kinetic;
    if (kinetic < before) {
      const auto u = body.displacement();
      body.set_state(
          {std::vector<double>(u[0].begin(), u[0].end()), std::vector<double>(u[1].begin(), u[1].end()),
           std::vector<double>(u[2].begin(), u[2].end())},
          still);
      before = 0;
    } else {
      before = kinetic;
    }
  }
  body.observe(pressure);
}

}  // namespace rhexis::test
