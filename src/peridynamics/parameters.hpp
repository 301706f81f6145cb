// SPDX-License-Identifier: BSD-3-Clause
/// Input keys of one vessel's peridynamic model, declared once: `rhexis keys` prints what stands in the .cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/parameter.hpp"
#include "core/precision.hpp"
#include "peridynamics/geometry/heterogeneity_parameters.hpp"
#include "peridynamics/laws/law_parameters.hpp"

namespace rhexis::peridynamics {

/// How both ends are held: not at all, still, without axial motion, or joined to each other.
enum class EndCondition { free, clamped, sliding, axial_periodic };

constexpr auto name_table(EndCondition) {
  using enum EndCondition;
  return std::to_array<Named<EndCondition>>(
      {{free, "free"}, {clamped, "clamped"}, {sliding, "sliding"}, {axial_periodic, "axial_periodic"}});
}

/// How particles are arranged over the cross-section.
enum class Arrangement { polar, lattice };

constexpr auto name_table(Arrangement) {
  using enum Arrangement;
  return std::to_array<Named<Arrangement>>({{polar, "polar"}, {lattice, "lattice"}});
}

/// See bonds/surface_correction.hpp.
enum class SurfaceCorrection { automatic, none, volume, energy, calibrated };

constexpr auto name_table(SurfaceCorrection) {
  using enum SurfaceCorrection;
  return std::to_array<Named<SurfaceCorrection>>({{automatic, "auto"},
                                                  {none, "none"},
                                                  {volume, "volume"},
                                                  {energy, "energy"},
                                                  {calibrated, "calibrated"}});
}

/// Course of the pressure in time (loads/schedule.hpp).
enum class Schedule { step, ramp, smooth_ramp, table };

constexpr auto name_table(Schedule) {
  using enum Schedule;
  return std::to_array<Named<Schedule>>(
      {{step, "step"}, {ramp, "ramp"}, {smooth_ramp, "smooth_ramp"}, {table, "table"}});
}

/// How the pressure is distributed over its layer (loads/pressure_layer.hpp).
enum class LayerForce { nonlocal, consistent, paper };

constexpr auto name_table(LayerForce) {
  using enum LayerForce;
  return std::to_array<Named<LayerForce>>(
      {{nonlocal, "nonlocal"}, {consistent, "consistent"}, {paper, "paper"}});
}

/// Whether the pressure acts on the deformed lumen (loads/lumen_surface.hpp) or on the undeformed one.
enum class LoadDirection { follower, dead };

constexpr auto name_table(LoadDirection) {
  using enum LoadDirection;
  return std::to_array<Named<LoadDirection>>({{follower, "follower"}, {dead, "dead"}});
}

/// What becomes of the load after rupture.
enum class Venting { none, orifice };

constexpr auto name_table(Venting) {
  using enum Venting;
  return std::to_array<Named<Venting>>({{none, "none"}, {orifice, "orifice"}});
}

/// All in SI units. Values that "auto" leaves empty are filled in by `resolve`.
struct Parameters {
  double inner_radius = 0, outer_radius = 0, length = 0;  ///< m

  double density = 1300;         ///< kg/m3
  double young_modulus = 3.5e6;  ///< Pa
  std::optional<double> critical_stretch;
  std::optional<double> energy_release_rate;  ///< J/m2; empty once critical_stretch has been found from it
  LawChoice law;

  Arrangement cross_section = Arrangement::polar;
  SurfaceCorrection surface_correction = SurfaceCorrection::automatic;
  std::optional<double> spacing;  ///< m
  std::optional<std::int64_t> particles;
  std::optional<double> horizon;        ///< m
  std::optional<double> horizon_ratio;  ///< horizon / spacing where `horizon` is "auto"
  std::vector<double> lattice_shift{
      0.5, 0.5};        ///< offset of the nearest column from the axis, in spacings: along x and along y
  double rotation = 0;  ///< rad
  Precision bond_precision = Precision::single_precision;

  EndCondition ends = EndCondition::clamped;
  std::optional<double> end_length;  ///< m held at each end

  double equilibrium_pressure = 0;  ///< Pa, 0: the run starts from the unloaded wall
  double equilibrium_tolerance = 1e-4;
  double schedule_start = 0;  ///< s of the schedule at which the run starts

  double pressure = 238e3;  ///< Pa
  Schedule schedule = Schedule::ramp;
  std::optional<double> ramp_time;  ///< s
  std::vector<CurvePoint> table;    ///< (s, Pa)
  std::string table_file;           ///< where the table comes from; empty: the input itself
  bool repeat = false;              ///< the table, again and again
  LoadDirection direction = LoadDirection::follower;
  LayerForce layer = LayerForce::nonlocal;
  std::optional<double> layer_thickness;  ///< m
  Venting venting = Venting::orifice;
  std::optional<double> supply_area;  ///< m2
  double discharge_coefficient = 0.62;
  double blood_density = 1060;  ///< kg/m3

  std::optional<double> time_step;  ///< s
  double step_fraction = 0.65;
  bool allow_unstable = false;
  double end_time = 0;  ///< s

  Scatter scatter;
  Spots spots;
};

/// The keys of sections vessel, material, scatter, spot, discretisation, boundary, load and time, bound to
/// `p`.
ParameterList declare(Parameters& p);

/// The keys of section start.
ParameterList declare_start(Parameters& p);

/// Checks what one key alone cannot tell (radii, horizon, table, ...) and fills spacing, horizon,
/// critical_stretch, ramp_time, layer_thickness, end_length, supply_area, schedule_start and
/// correlation_length. Throws InputError with the key at fault. Returns warnings.
std::vector<std::string> resolve(Parameters& p);

/// Makes the whole wall `factor` times as stiff.
void scale_stiffness(Parameters& p, double factor);

/// Spacing (m) that cuts the wall's volume into `particles` cubes, Sec. 3.3: (pi (r1^2 - r0^2) L / N)^(1/3).
double constant_number_spacing(double inner_radius, double outer_radius, double length, double particles);

}  // namespace rhexis::peridynamics
