// SPDX-License-Identifier: BSD-3-Clause
/// Input keys of one vessel's peridynamic model, declared once: `rhexis keys` prints what stands in the .cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/parameter.hpp"
#include "peridynamics/geometry/heterogeneity_parameters.hpp"
#include "peridynamics/laws/law_parameters.hpp"

namespace rhexis::peridynamics {

enum class EndCondition { free, clamped, axial_periodic, sliding };

/// All in SI units. Values that "auto" leaves empty are filled in by `resolve`.
struct Parameters {
  double inner_radius = 0, outer_radius = 0, length = 0;  ///< m

  double density = 1300;        ///< kg/m3
  double young_modulus = 3.5e6;  ///< Pa
  std::optional<double> critical_stretch;
  std::optional<double> energy_release_rate;  ///< J/m2; empty once critical_stretch has been found from it
  LawChoice law;

  std::string cross_section = "polar";       ///< "lattice" | "polar"
  std::string surface_correction = "auto";  ///< see surface_correction.hpp
  std::optional<double> spacing;   ///< m
  std::optional<std::int64_t> particles;
  std::optional<double> horizon;      ///< m
  double horizon_ratio = 3.5;           ///< horizon / spacing where `horizon` is "auto"
  std::vector<double> lattice_shift{0.5, 0.5};  ///< of the nearest column from the axis, in spacings, two numbers
  double rotation = 0;                ///< rad
  std::string bond_precision = "single";         ///< "single" | "double"

  std::string ends = "clamped";                  ///< see EndCondition
  std::optional<double> end_length;  ///< m held at each end

  double equilibrium_pressure = 0;  ///< Pa, 0: the run starts from the unloaded wall
  double equilibrium_tolerance = 1e-4;
  double schedule_start = 0;  ///< s of the schedule at which the run starts

  double pressure = 238e3;                    ///< Pa
  std::string schedule = "ramp";                   ///< "step" | "ramp" | "smooth_ramp" | "table"
  std::optional<double> ramp_time;        ///< s
  std::vector<CurvePoint> table;          ///< (s, Pa)
  std::string table_file;                 ///< where the table comes from; empty: the input itself
  bool repeat = false;                    ///< the table, again and again
  std::string layer = "nonlocal";                      ///< see PressureLayer
  std::optional<double> layer_thickness;  ///< m
  std::string venting = "orifice";                    ///< "none" | "orifice"
  std::optional<double> supply_area;      ///< m2
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

/// Spacing (m) that cuts the wall's volume into `particles` cubes, Sec. 3.3: (pi (r1^2 - r0^2) L / N)^(1/3).
double constant_number_spacing(double inner_radius, double outer_radius, double length, double particles);

EndCondition end_condition(const Parameters& p);

}  // namespace rhexis::peridynamics
