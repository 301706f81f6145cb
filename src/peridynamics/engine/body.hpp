// SPDX-License-Identifier: BSD-3-Clause
/// A vessel's wall in motion: state, bonds, one time step, and what observers may know of it.
///
/// Velocity Verlet in its leapfrog form, one pass over memory a step: forces at t_n, then
///   v_{n+1/2} = v_{n-1/2} + dt a_n,   u_{n+1} = u_n + dt v_{n+1/2};
/// the velocity at t_n is v_{n-1/2} + dt/2 a_n. Displacements that bonds read are kept a second time, in the
/// bonds' precision and in spacings, in two padded copies: one is read while the other is written.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/id_ranges.hpp"
#include "parallel/communicator.hpp"
#include "parallel/halo.hpp"
#include "peridynamics/engine/body_setup.hpp"
#include "peridynamics/engine/body_size.hpp"
#include "peridynamics/engine/column_layout.hpp"

namespace rhexis::peridynamics {

/// What happened on this rank in one step.
struct StepEvents {
  std::int64_t broken = 0;  ///< directed bonds broken by the forces' evaluation at t_n
  bool damaged = false;     ///< a particle's damage has reached `rupture_damage`
  bool unstable =
      false;  ///< a particle is faster than the load can make it (see ColumnBody), or not a number
};

/// Damage from which a particle counts as ruptured (run.json: rupture_onset_s, rupture_length_m).
inline constexpr double rupture_damage = 0.2;

/// Per-particle values at one moment, owned particles; SI units.
struct Observation {
  std::array<std::vector<double>, 3> velocity;       ///< m/s
  std::array<std::vector<double>, 3> force_density;  ///< N/m3: bonds and pressure
  std::vector<double> strain_energy_density;         ///< J/m3
  std::vector<double> damage;  ///< Eq. (6), 0..1; not a number where thin spots leave no particle

  static double bytes(double particles) { return 8 * particles * sizeof(double); }
};

/// Sums over the whole body (all ranks), independent of the partition. SI units.
struct Totals {
  double kinetic = 0, strain = 0, fracture = 0, external_work = 0;  ///< J
  double lost = 0;                                                  ///< J, at most, in each of these sums
  double max_displacement = 0;                                      ///< m
  double max_damage = 0;
  std::int64_t broken_bonds = 0;  ///< undirected
  /// Undirected bonds shorter than half their length. Across such a bond the force turns faster than the
  /// stiffness along it allows for, by which the stable time step is bounded.
  std::int64_t crushed_bonds = 0;
  double rupture_length = 0;  ///< m, axial extent of damage >= rupture_damage, reference rows
};

/// Whether the body holds no more energy than was put into it; more is the surest sign of a time step that is
/// too long. A tolerance of 100 % allows for velocities that are half a step ahead of the work, which early
/// in a run is as much again. Over-compressed bonds void the stability bound: the tolerance drops to 10 %.
/// What the sums may have lost (`lost`) is allowed for too.
inline bool holds_no_more_than_was_put_in(const Totals& t) {
  const double energy = t.kinetic + t.strain + t.fracture;
  return std::isfinite(energy) &&
         energy <= (t.crushed_bonds > 0 ? 1.1 : 2.0) * (std::abs(t.external_work) + t.lost);
}

struct WallDeformation;

class Body {
 public:
  virtual ~Body() = default;

  /// Which of all particles are on this rank; all arrays of particles are in this order.
  virtual const IdRanges& ids() const = 0;
  /// The topology of a tube; null of any other body. For those that measure tubes only.
  virtual const ColumnLayout* columns() const { return nullptr; }
  /// Displacement u (m) of owned particles, structure of arrays.
  virtual std::array<std::span<const double>, 3> displacement() const = 0;
  /// Reference position (m) of an owned particle.
  virtual std::array<double, 3> reference_position(std::size_t particle) const = 0;
  /// Volumes (m3) of owned particles.
  virtual std::vector<double> volumes() const = 0;
  /// The largest force density of the load for a pressure of 1, anywhere; 1/m.
  virtual double largest_load() const = 0;
  /// Sets the components that the ends hold to 0 in a vector field over owned particles.
  virtual void clear_held(std::array<std::vector<double>, 3>& field) const = 0;

  /// Sets displacement (m) and velocity (m/s) at the present time; bonds stay as they are.
  virtual void set_state(const std::array<std::vector<double>, 3>& displacement,
                         const std::array<std::vector<double>, 3>& velocity) = 0;

  /// Sets the pressure at each height z (m) relative to the one that steps are given, 0 to 1; it is 1 until
  /// then. The profile takes effect on work and observations too.
  virtual void set_axial_profile(const std::function<double(double z)>& profile) = 0;

  /// Advances by one step under `pressure` (Pa) at t_n; `next_pressure` is the one at t_{n+1}, for the work
  /// done. Collective.
  virtual StepEvents advance(double pressure, double next_pressure) = 0;

  /// Breaks the bonds that are due at the present time and sums forces and energies under `pressure` (Pa);
  /// the next `observe` or `advance` at this time uses them. Collective.
  virtual void find_forces(double pressure) = 0;
  /// Breaks the bonds that are due at the present time and returns the force density (N/m3: bonds and
  /// pressure) under `pressure` (Pa), without the other fields. Collective; valid until the next call.
  virtual const std::array<std::vector<double>, 3>& force_density(double pressure) {
    return observe(pressure).force_density;
  }
  /// Breaks the bonds that are due at the present time and evaluates all fields under `pressure` (Pa).
  /// Collective. The reference stays valid until the next call.
  virtual const Observation& observe(double pressure) = 0;
  /// Whether its law is one by gradient, on a wall: then wall_deformation says more of what was observed.
  virtual bool has_wall_deformation() const { return false; }
  /// Deformation and stress of an owned particle at the last observation.
  virtual WallDeformation wall_deformation(std::size_t particle) const;
  /// The sums at the last observation. Collective.
  virtual Totals totals() const = 0;
  /// Largest |u|, m. Collective.
  virtual double max_displacement() const = 0;

  /// Undirected bonds of the whole body before anything breaks. Collective.
  virtual std::int64_t bonds() const = 0;
  /// Directed bonds whose forces were summed so far, on this rank.
  virtual std::int64_t bond_evaluations() const = 0;

  /// What exchanging halos has cost so far, on this rank.
  virtual parallel::Traffic traffic() const = 0;

  /// All that a restart needs.
  struct Saved {
    std::array<std::vector<double>, 3> displacement, leapfrog_velocity;  ///< m, m/s, of owned particles
    std::vector<std::uint16_t> words;  ///< bits of the bonds, see word_table
    bool first_kick_pending = false;   ///< velocities are at the same time as displacements
    /// J, exact as two doubles (ExactSum::parts): the work done so far, and the energy of dilatation that
    /// breaking bonds released, 0 where the law has none.
    std::array<double, 2> external_work{}, released_energy{};
    double load_speed = 0;          ///< m/s, see ColumnBody
    std::array<double, 3> frame{};  ///< m, origin of FollowingFrame
    bool wrapped = false;           ///< FollowingFrame::wrapped
    long frame_phase = 0;           ///< steps since the frame last looked at the body's motion
    /// Force and displacement of the loaded surface at each particle when forces were last evaluated, from
    /// which the general engine finds the work of the step since then. Columns leave it empty.
    std::array<std::vector<double>, 6> surface = {};

    static double bytes(const BodySize& size) {
      return 6 * size.particles() * sizeof(double) + size.words() * sizeof(std::uint16_t);
    }
  };
  /// Where this rank's words of bonds' bits lie among those of the whole body.
  virtual TablePart word_table() const = 0;
  virtual Saved save() const = 0;
  virtual void restore(const Saved& saved) = 0;
};

std::unique_ptr<Body> make_body(BodySetup setup, parallel::Communicator comm);

/// Memory that a body of this size takes on all ranks, without its families and before it is observed.
double body_bytes(const LawChoice& law, bool double_bonds, const BodySize& size);

}  // namespace rhexis::peridynamics
