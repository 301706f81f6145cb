// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/statics/equilibrium.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/format.hpp"
#include "parallel/exact_sum.hpp"
#include "peridynamics/engine/general_body.hpp"
#include "peridynamics/stability/time_steps.hpp"

namespace rhexis::peridynamics {
namespace {

using Field = std::array<std::vector<double>, 3>;

constexpr double unbreakable = 1e6;  ///< critical stretch

/// Bitzek et al.'s values: the share of the velocity that is turned towards the force at first, the factor by
/// which it falls each step, and the number of steps before it begins to fall.
constexpr double first_turn = 0.1, turn_decay = 0.99;
constexpr int steps_before_decay = 5;

class Relaxation {
 public:
  /// A body whose bonds do not break. `volume`: m3, of a usual particle.
  Relaxation(std::unique_ptr<Body> body, double stable_step, double density, double volume, double pressure,
             parallel::Communicator comm)
      : pressure_(pressure),
        comm_(comm),
        body_(std::move(body)),
        // Inertia is only a means here: the longer the step, the fewer are needed, but turned velocities are
        // not those of leapfrog, and with the whole stable step a wall came to no rest.
        step_(0.65 * stable_step),
        load_(pressure * body_->largest_load()),
        density_(density),
        usual_volume_(volume),
        volumes_(body_->volumes()) {
    for (std::size_t k = 0; k < 3; ++k) {
      displacement_[k].assign(volumes_.size(), 0.0);
      velocity_[k].assign(volumes_.size(), 0.0);
    }
  }

  Equilibrium run(double tolerance, long most_steps) {
    Equilibrium found;
    for (; found.steps < most_steps; ++found.steps) {
      force_ = body_->force_density(pressure_);
      body_->clear_held(force_);
      found.residual = largest_force() / load_;
      if (found.residual <= tolerance) {
        const Observation& seen = body_->observe(pressure_);
        found.largest_energy_density = comm_.all_reduce(
            *std::max_element(seen.strain_energy_density.begin(), seen.strain_energy_density.end()),
            parallel::Reduce::max);
        found.strain_energy = body_->totals().strain;
        found.displacement = std::move(displacement_);
        found.bond_evaluations = body_->bond_evaluations();
        return found;
      }
      if (!std::isfinite(found.residual))
        throw RunError("the wall does not bear " + quantity(pressure_, "Pa") +
                       ": it widens without end; take a lower pressure");
      step();
      body_->set_state(displacement_, velocity_);
    }
    throw RunError("the wall comes to no rest under " + quantity(pressure_, "Pa") + ": after " +
                   std::to_string(found.steps) + " steps of relaxation a force is still " +
                   text(found.residual) + " of the load's" +
                   (found.residual < 1e-4 ? "; bonds in double precision come nearer to rest" : ""));
  }

 private:
  double largest_force() const {
    double largest = 0;
    for (const std::vector<double>& component : force_) {
      for (double f : component) largest = std::isnan(f) ? INFINITY : std::max(largest, std::abs(f));
    }
    return comm_.all_reduce(largest, parallel::Reduce::max);
  }

  /// Velocity, then displacement.
  void step() {
    const double usual_speed = 100 * load_ / density_ * step_;
    parallel::ExactSum power(load_ * usual_speed), forces(load_ * load_), speeds(usual_speed * usual_speed);
    for (std::size_t i = 0; i < force_[0].size(); ++i) {
      const double share = volumes_[i] / usual_volume_;
      double fv = 0, ff = 0, vv = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        fv += force_[k][i] * velocity_[k][i];
        ff += force_[k][i] * force_[k][i];
        vv += velocity_[k][i] * velocity_[k][i];
      }
      power.add(share * fv);
      forces.add(share * ff);
      speeds.add(share * vv);
    }
    double kept = 0, turned = 0;  // of the velocity; of the force, as a velocity
    if (power.value(comm_) > 0) {
      kept = 1 - turn_;
      turned = turn_ * std::sqrt(speeds.value(comm_) / forces.value(comm_));
      if (++downhill_ > steps_before_decay) turn_ *= turn_decay;
    } else {
      turn_ = first_turn;
      downhill_ = 0;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < force_[k].size(); ++i) {
        velocity_[k][i] = kept * velocity_[k][i] + (turned + step_ / density_) * force_[k][i];
        displacement_[k][i] += step_ * velocity_[k][i];
      }
    }
  }

  double pressure_;
  parallel::Communicator comm_;
  std::unique_ptr<Body> body_;
  double step_;                    ///< s
  double load_;                    ///< N/m3, the largest of the pressure
  double density_, usual_volume_;  ///< kg/m3; m3, the unit of volumes in sums
  std::vector<double> volumes_;    ///< m3
  Field displacement_, velocity_, force_;
  double turn_ = first_turn;
  int downhill_ = 0;  ///< steps since the forces last did no work
};

}  // namespace

Equilibrium find_equilibrium(BodySetup setup, double pressure, double tolerance, parallel::Communicator comm,
                             long most_steps) {
  const double step = stable_time_step(setup), volume = setup.lattice.volume(0), density = setup.density;
  setup.critical_stretch = unbreakable;
  return Relaxation(make_body(std::move(setup), comm), step, density, volume, pressure, comm)
      .run(tolerance, most_steps);
}

Equilibrium find_equilibrium(const WallModel& wall, double pressure, double tolerance,
                             parallel::Communicator comm, long most_steps) {
  if (!wall.by_gradient()) return find_equilibrium(wall.setup, pressure, tolerance, comm, most_steps);
  auto setup = std::make_shared<GeneralSetup>(*wall.general.setup);
  setup->critical_stretch = unbreakable;
  return Relaxation(make_body(std::move(setup), comm), wall.time.stable, wall.parameters.density,
                    wall.lattice().volume(0), pressure, comm)
      .run(tolerance, most_steps);
}

}  // namespace rhexis::peridynamics
