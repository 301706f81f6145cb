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
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/field_view.hpp"
#include "parallel/communicator.hpp"
#include "parallel/halo.hpp"
#include "peridynamics/bonds/bond_family.hpp"
#include "peridynamics/geometry/heterogeneity.hpp"
#include "peridynamics/loads/thin_spots.hpp"

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

/// Per-particle values at one moment, owned particles, column by column; SI units.
struct Observation {
  std::array<std::vector<double>, 3> velocity;       ///< m/s
  std::array<std::vector<double>, 3> force_density;  ///< N/m3: bonds and pressure
  std::vector<double> strain_energy_density;         ///< J/m3
  std::vector<double> damage;  ///< Eq. (6), 0..1; not a number where thin spots leave no particle
};

/// Sums over the whole body (all ranks), independent of the partition. SI units.
struct Totals {
  double kinetic = 0, strain = 0, fracture = 0, external_work = 0;  ///< J
  double lost = 0;                                                  ///< J, at most, in each of these sums
  double max_displacement = 0;                                      ///< m
  double max_damage = 0;
  std::int64_t broken_bonds = 0;  ///< undirected
  /// Undirected, shorter than half their length: across such a bond the force turns faster than the bond's
  /// stiffness, for which alone the time step is known to be stable.
  std::int64_t crushed_bonds = 0;
  double rupture_length = 0;  ///< m, axial extent of damage >= rupture_damage, reference rows
};

/// Whether the energies fit the work done. Energy out of nowhere, or none to speak of, is the surest sign of
/// a time step that is too long. Leapfrog's velocities may be half a step ahead of the work, which is as much
/// again early on; a wall whose bonds are crushed is not so young, and its step is known to be stable no
/// longer: a tenth too much is refused. What sums may have lost is nothing to speak of.
inline bool holds_no_more_than_was_put_in(const Totals& t) {
  const double energy = t.kinetic + t.strain + t.fracture;
  return std::isfinite(energy) &&
         energy <= (t.crushed_bonds > 0 ? 1.1 : 2.0) * (std::abs(t.external_work) + t.lost);
}

/// This rank's part of the table of bond words of the whole body: a row per bond of each column's family, a
/// word per 16 particles along the axis.
struct BondWordLayout {
  std::int64_t rows = 0, words = 0;  ///< of the whole body
  std::int64_t first_row = 0, row_count = 0;
  std::int64_t first_word = 0, word_count = 0;
};

class Body {
 public:
  virtual ~Body() = default;

  virtual const PointLayout& layout() const = 0;
  /// Displacement u (m) of owned particles, structure of arrays.
  virtual std::array<std::span<const double>, 3> displacement() const = 0;
  /// Reference positions (m) of owned particle (local column, local row).
  virtual std::array<double, 3> reference_position(std::int64_t column, std::int64_t row) const = 0;

  /// Sets displacement (m) and velocity (m/s) at the present time; all bonds as they are.
  virtual void set_state(const std::array<std::vector<double>, 3>& displacement,
                         const std::array<std::vector<double>, 3>& velocity) = 0;

  /// The pressure in each row [rows of the whole body] relative to the one that steps are given, 0 to 1; all
  /// 1 before. Also takes effect on work and observations.
  virtual void set_axial_profile(std::vector<double> profile) = 0;

  /// Advances by one step under `pressure` (Pa) at t_n; `next_pressure` is the one at t_{n+1}, for the work
  /// done. Collective.
  virtual StepEvents advance(double pressure, double next_pressure) = 0;

  /// Breaks what is due at the present time and sums forces and energies, which `observe` then finds done,
  /// and `advance` too. Collective.
  virtual void find_forces() = 0;
  /// Breaks what is due at the present time and evaluates all fields. Collective. The reference stays valid
  /// until the next call.
  virtual const Observation& observe(double pressure) = 0;
  /// Of the last observation. Collective.
  virtual Totals totals() const = 0;
  /// Largest |u|, m. Collective.
  virtual double max_displacement() const = 0;

  /// Undirected bonds that the whole body was born with. Collective.
  virtual std::int64_t bonds() const = 0;
  /// Directed bonds whose forces were summed so far, on this rank.
  virtual std::int64_t bond_evaluations() const = 0;

  /// Of halos so far, on this rank.
  virtual parallel::Traffic traffic() const = 0;

  /// All that a restart needs beside displacement: leapfrog velocity (m/s), bond words and the work done so
  /// far. Words stand row by row as `bond_word_layout` says.
  struct Saved {
    std::array<std::vector<double>, 3> displacement, leapfrog_velocity;
    std::vector<std::uint16_t> words;
    bool first_kick_pending = false;
    /// J, sums exact as two doubles (ExactSum::parts): work done so far, and energy of dilatation that
    /// breaking bonds released, 0 where the law has none.
    std::array<double, 2> external_work{}, released_energy{};
    double load_speed = 0;          ///< m/s, see ColumnBody
    std::array<double, 3> frame{};  ///< m
    bool wrapped = false;           ///< see ColumnBody::follow_body
    long frame_phase = 0;           ///< steps since the body's motion was looked at
  };
  virtual BondWordLayout bond_word_layout() const = 0;
  virtual Saved save() const = 0;
  virtual void restore(const Saved& saved) = 0;
};

struct BodySetup {
  Lattice lattice;
  SharedFamilies families;
  PressureLayer layer;
  EndCondition ends = EndCondition::free;
  double end_length = 0;  ///< m held at each end
  double density = 0;     ///< kg/m3
  LawChoice law = {};
  double bond_constant = 0;  ///< N/m6
  double critical_stretch = 0;
  double time_step = 0;     ///< s
  double energy_scale = 0;  ///< J, order of magnitude of the energies that will occur
  bool double_bonds = false;
  Heterogeneity heterogeneity = {};
  ThinSpots thin_spots = {};
};

/// Rows of the whole body, [first, past), whose motion along axis `component` the ends do not hold: clamped
/// ends hold all components, sliding ones the axial one.
std::pair<std::int64_t, std::int64_t> free_rows(const BodySetup& setup, int component);

/// The setup that resolved parameters describe.
BodySetup make_setup(const Parameters& p, Lattice lattice, SharedFamilies families, double time_step);

std::unique_ptr<Body> make_body(BodySetup setup, parallel::Communicator comm);

}  // namespace rhexis::peridynamics
