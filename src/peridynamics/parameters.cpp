// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "core/error.hpp"
#include "core/format.hpp"
#include "peridynamics/laws/all_laws.hpp"
#include "peridynamics/laws/correspondence/neo_hookean.hpp"
#include "peridynamics/laws/strength.hpp"
#include "peridynamics/loads/schedule.hpp"

namespace rhexis::peridynamics {

namespace {

/// That material.law is one of bonds, which columns of particles run.
Condition law_of_bonds() {
  Condition condition{"material.law"};
  for_each_law([&]<class Law>() { condition.values.push_back('"' + std::string(Law::name) + '"'); });
  return condition;
}

/// That the wall's stiffness is told by one modulus, not layer by layer.
Condition law_of_one_modulus() {
  Condition condition = law_of_bonds();
  condition.values.push_back('"' + std::string(NeoHookean::name) + '"');
  return condition;
}

}  // namespace

ParameterList declare(Parameters& p) {
  ParameterList all{
      {.key = "vessel.inner_radius",
       .target = &p.inner_radius,
       .unit = "m",
       .meaning = "Radius of the lumen, r0.",
       .source = "Table 2",
       .range = Range::positive(),
       .required = true},
      {.key = "vessel.outer_radius",
       .target = &p.outer_radius,
       .unit = "m",
       .meaning = "Outer radius of the wall, r1.",
       .source = "Table 2",
       .range = Range::positive(),
       .required = true},
      {.key = "vessel.length",
       .target = &p.length,
       .unit = "m",
       .meaning = "Axial length of the vessel, L.",
       .source = "Table 2",
       .range = Range::positive(),
       .required = true},
      {.key = "material.density",
       .target = &p.density,
       .unit = "kg/m3",
       .default_in = "g/cm3",
       .meaning = "Mass density of the wall.",
       .source = "Table 2",
       .range = Range::positive()},
      {.key = "material.young_modulus",
       .target = &p.young_modulus,
       .unit = "Pa",
       .default_in = "MPa",
       .meaning = "Young's modulus of the wall.",
       .source = "Table 2, Eq. (4)",
       .range = Range::positive(),
       .only_with = {law_of_one_modulus()}},
      {.key = "material.critical_stretch",
       .target = &p.critical_stretch,
       .unit = "1",
       .meaning = "Stretch at which a bond breaks, s0; \"auto\" is what energy_release_rate gives, or 0.25.",
       .source = "Table 2, Eq. (5)",
       .range = Range::between(1e-6, 10)},
      {.key = "material.energy_release_rate",
       .target = &p.energy_release_rate,
       .unit = "J/m2",
       .meaning = "Work to tear a unit of area, G0, in place of critical_stretch: s0 = sqrt(5 G0 / (6 E "
                  "delta)) then follows the horizon (with law = \"fung\", sqrt(ln(1 + a s0^2) / a) of that "
                  "s0; not with \"lps\").",
       .source = "Silling & Askari 2005, with Eq. (4)",
       .range = Range::positive()},
      {.key = "discretisation.cross_section",
       .target = &p.cross_section,
       .meaning = "Arrangement of particles over the cross-section: rings that follow the wall, or the "
                  "paper's cubic lattice clipped to the wall.",
       .source = "Sec. 3.2"},
      {.key = "discretisation.surface_correction",
       .target = &p.surface_correction,
       .meaning =
           "Weights of bonds that make up for what families near a surface lack: none (the paper); volume; "
           "energy; or calibrated, so that the wall has the elastic energy of every homogeneous strain "
           "(polar only). \"auto\" is calibrated on a polar cross-section, none on a lattice.",
       .source = "Le & Bobaru 2018; Madenci & Oterkus 2014; Prakash 2018"},
      {.key = "discretisation.spacing",
       .target = &p.spacing,
       .unit = "m",
       .meaning = "Distance between particles; \"auto\" takes it from discretisation.particles.",
       .source = "Table 2; Sec. 3.3",
       .range = Range::positive()},
      {.key = "discretisation.particles",
       .target = &p.particles,
       .unit = "1",
       .meaning = "Number of particles N to aim at; sets the spacing (pi (r1^2 - r0^2) L / N)^(1/3).",
       .source = "Sec. 3.3",
       .range = Range::between(100, 4e9)},
      {.key = "discretisation.horizon",
       .target = &p.horizon,
       .unit = "m",
       .meaning = "Radius of a particle's family, delta; \"auto\" is horizon_ratio spacings.",
       .source = "Table 2",
       .range = Range::positive()},
      {.key = "discretisation.horizon_ratio",
       .target = &p.horizon_ratio,
       .unit = "1",
       .meaning = "Horizon in spacings where horizon is \"auto\"; \"auto\" is 3.5, with a law by "
                  "deformation gradient 2.2.",
       .source = "Sec. 3.3",
       .range = Range::between(1.6, 8),
       .only_with = {{"discretisation.horizon", {"\"auto\""}}}},
      {.key = "discretisation.lattice_shift",
       .target = &p.lattice_shift,
       .unit = "1",
       .meaning = "Where the lattice falls: offset of its nodes from the axis in x and y, in spacings (0.5: "
                  "the axis lies between four columns; 0: on a column).",
       .range = Range::between(0, 1),
       .only_with = {when("discretisation.cross_section", Arrangement::lattice)}},
      {.key = "discretisation.rotation",
       .target = &p.rotation,
       .unit = "rad",
       .meaning = "Turn of the arrangement about the vessel's axis: results should not depend on it."},
      {.key = "discretisation.bond_precision",
       .target = &p.bond_precision,
       .meaning = "Arithmetic of the bonds; positions and velocities are always double."},
      {.key = "boundary.ends",
       .target = &p.ends,
       .meaning = "Both ends: free; clamped (held still); sliding (no axial motion, radial motion free); "
                  "axial_periodic (a piece of an endless vessel)."},
      {.key = "boundary.end_length",
       .target = &p.end_length,
       .unit = "m",
       .meaning = "Length held at each end where ends are clamped or sliding; \"auto\" is one horizon.",
       .range = Range::positive(),
       .only_with = {when("boundary.ends", EndCondition::clamped, EndCondition::sliding)}},
      {.key = "load.pressure",
       .target = &p.pressure,
       .unit = "Pa",
       .default_in = "kPa",
       .meaning = "Net pressure on the lumen, P_net, after the schedule: a blood pressure, unless "
                  "load.direction is \"dead\".",
       .source = "Table 2, Eqs. (7), (8)",
       .range = Range::not_negative(),
       .only_with = {when("load.schedule", Schedule::step, Schedule::ramp, Schedule::smooth_ramp)}},
      {.key = "load.schedule",
       .target = &p.schedule,
       .meaning = "Course of the pressure: full at once; linear ramp; ramp as half a cosine; or load.table."},
      {.key = "load.ramp_time",
       .target = &p.ramp_time,
       .unit = "s",
       .meaning = "Duration of a ramp; \"auto\" is time.end.",
       .range = Range::positive(),
       .only_with = {when("load.schedule", Schedule::ramp, Schedule::smooth_ramp)}},
      {.key = "load.table",
       .target = &p.table,
       .unit = "s, Pa",
       .meaning = "Pressure by time, as load.pressure, linear in between, constant "
                  "outside: [[\"0 ms\", \"0 kPa\"], [\"2 ms\", \"200 kPa\"]].",
       .range = Range::not_negative()},
      {.key = "load.table_file",
       .target = &p.table_file,
       .meaning = "CSV file to read the table from, instead of load.table: a header \"time [s],pressure "
                  "[mmHg]\" (any units), then a row for each point. Looked for from the working folder, then "
                  "beside the input.",
       .only_with = {when("load.schedule", Schedule::table)}},
      {.key = "load.repeat",
       .target = &p.repeat,
       .meaning = "Repeat the table, as heart beats do: it begins at 0, its last time is the period, and its "
                  "first and last pressure agree.",
       .only_with = {when("load.schedule", Schedule::table)}},
      {.key = "load.direction",
       .target = &p.direction,
       .meaning =
           "follower: a blood pressure, which acts on the deformed lumen, on its area and along its "
           "normals, and not where the wall is torn. dead: the paper's, on the undeformed lumen's area "
           "in its undeformed directions; 282 kPa then push a lumen stretched by 1.27 as hard as a "
           "blood pressure of 222 kPa.",
       .source = "Eq. (8)"},
      {.key = "load.layer",
       .target = &p.layer,
       .meaning = "Body force of the pressure in the innermost layer of the wall: nonlocal (distributed as "
                  "bonds pull that a surface cuts, resultant exactly P 2 pi r0 L), consistent (the same "
                  "everywhere, resultant exact) or paper (P / thickness).",
       .source = "Eq. (8)",
       .only_with = {law_of_bonds()}},
      {.key = "load.layer_thickness",
       .target = &p.layer_thickness,
       .unit = "m",
       .meaning = "Thickness of the loaded layer, from r0 outwards; \"auto\" is one horizon.",
       .source = "Eq. (8)",
       .range = Range::positive(),
       .only_with = {law_of_bonds()}},
      {.key = "load.venting",
       .target = &p.venting,
       .meaning = "After rupture: none (the load goes on, as in the paper) or orifice "
                  "(the pressure falls as the wall opens: P / (1 + (A_open / A_supply)^2))."},
      {.key = "load.supply_area",
       .target = &p.supply_area,
       .unit = "m2",
       .meaning =
           "Area through which blood is supplied to the ruptured vessel; \"auto\" is the lumen, pi r0^2.",
       .range = Range::positive(),
       .only_with = {when("load.venting", Venting::orifice)}},
      {.key = "load.discharge_coefficient",
       .target = &p.discharge_coefficient,
       .unit = "1",
       .meaning = "Of the opening, in the leak Cd A_open sqrt(2 P / rho_blood).",
       .source = "orifice law",
       .range = {.lower = 0, .upper = 1, .lower_open = true}},
      {.key = "load.blood_density",
       .target = &p.blood_density,
       .unit = "kg/m3",
       .meaning = "Density of blood in the leak.",
       .range = Range::positive()},
      {.key = "time.end",
       .target = &p.end_time,
       .unit = "s",
       .meaning = "Simulated time.",
       .source = "Table 2",
       .range = Range::positive(),
       .required = true},
      {.key = "time.step",
       .target = &p.time_step,
       .unit = "s",
       .meaning = "Time step; \"auto\" is step_fraction of the stable one. The paper uses 500 ns.",
       .source = "Table 2",
       .range = Range::positive()},
      {.key = "time.step_fraction",
       .target = &p.step_fraction,
       .unit = "1",
       .meaning = "Share of the stable time step that \"auto\" takes.",
       .range = {.lower = 0, .upper = 1, .lower_open = true},
       .only_with = {{"time.step", {"\"auto\""}}}},
      {.key = "time.allow_unstable",
       .target = &p.allow_unstable,
       .meaning = "Take a time.step above the stable one all the same: to see where instability begins.",
       .only_with = {{"time.step", {}}}},
  };
  const ParameterList law = declare(p.law);  // with the other keys of its section
  all.insert(std::ranges::find(all, "discretisation.cross_section", &Parameter::key), law.begin(), law.end());
  std::ranges::copy(declare(p.scatter), std::back_inserter(all));
  std::ranges::copy(declare(p.spots), std::back_inserter(all));
  return all;
}

ParameterList declare_start(Parameters& p) {
  return {
      {.key = "start.equilibrium_pressure",
       .target = &p.equilibrium_pressure,
       .unit = "Pa",
       .meaning = "The run starts with the wall at rest in static equilibrium under this pressure, at the "
                  "moment at which the schedule first has it; 0: from the unloaded wall.",
       .range = Range::not_negative()},
      {.key = "start.tolerance",
       .target = &p.equilibrium_tolerance,
       .unit = "1",
       .meaning =
           "Largest force on a particle left over in that equilibrium, relative to the force of the load.",
       .range = Range::between(1e-12, 0.1),
       .only_with = {{"start.equilibrium_pressure", {}}}},
  };
}

void scale_stiffness(Parameters& p, double factor) {
  p.young_modulus *= factor;
  for (WallLayer& layer : p.law.wall.layers) layer.shear_modulus *= factor;
  for (FibreFamily& family : p.law.wall.fibres) family.k1 *= factor;
}

double constant_number_spacing(double inner_radius, double outer_radius, double length, double particles) {
  const double wall_area = std::numbers::pi * (outer_radius * outer_radius - inner_radius * inner_radius);
  return std::cbrt(wall_area * length / particles);
}

namespace {

void resolve_spacing(Parameters& p) {
  if (p.spacing && p.particles) {
    throw InputError("give either discretisation.spacing or discretisation.particles, not both",
                     "discretisation.particles");
  }
  if (!p.spacing && !p.particles) {
    throw InputError("give discretisation.spacing (a length) or discretisation.particles (a number)",
                     "discretisation.spacing");
  }
  if (!p.spacing) {
    p.spacing =
        constant_number_spacing(p.inner_radius, p.outer_radius, p.length, static_cast<double>(*p.particles));
  }
  if (!p.horizon) p.horizon = p.horizon_ratio.value_or(p.law.by_gradient() ? 2.2 : 3.5) * *p.spacing;
  const double ratio = *p.horizon / *p.spacing, least = p.law.by_gradient() ? 1.6 : 2;
  if (ratio < least) {
    throw InputError("the horizon is " + text(ratio) + " spacings; at least " + text(least) +
                         " are needed (" + (p.law.by_gradient() ? "2.2 is" : "3 to 4 are") +
                         " usual), here " + quantity(least * *p.spacing, "m"),
                     "discretisation.horizon");
  }
  if (ratio > 8) {
    throw InputError("the horizon is " + text(ratio) +
                         " spacings; at most 8 are allowed (3 to 4 are usual), here " +
                         quantity(8 * *p.spacing, "m"),
                     "discretisation.horizon");
  }
  const double wall = p.outer_radius - p.inner_radius;
  if (wall < *p.spacing) {
    throw InputError(
        "the wall (" + quantity(wall, "m") + ") is thinner than one spacing; take at most a third of it",
        "discretisation.spacing");
  }
  const double volume =
      std::numbers::pi * (p.outer_radius * p.outer_radius - p.inner_radius * p.inner_radius) * p.length;
  const double count = volume / (*p.spacing * *p.spacing * *p.spacing);
  if (count > 4e9) {
    throw InputError("the wall would hold " + text(count) + " particles; at most 4e9 are possible",
                     "discretisation.spacing");
  }
}

/// A table that is repeated has a period, and no leap between one and the next.
void check_period(const Parameters& p) {
  const auto& [first_time, first] = p.table.front();
  const auto& [period, last] = p.table.back();
  if (first_time != 0)
    throw InputError("a table that is repeated begins at 0 s, and this one at " + quantity(first_time, "s"),
                     "load.repeat");
  constexpr double tolerance = 1e-6;  // of the highest pressure: digits that people write
  if (std::abs(last - first) > tolerance * highest_pressure(p))
    throw InputError("a table that is repeated ends at the pressure that it begins with, " +
                         quantity(first, "Pa", 6) + ", and this one at " + quantity(last, "Pa", 6) + " (" +
                         quantity(period, "s") + ")",
                     "load.repeat");
}

void resolve_load(Parameters& p) {
  if (!p.ramp_time) p.ramp_time = p.end_time;
  if (!p.layer_thickness) p.layer_thickness = p.horizon;
  if (!p.supply_area) p.supply_area = std::numbers::pi * p.inner_radius * p.inner_radius;
  if (p.schedule == Schedule::table) {
    if (p.table.size() < 2) {
      throw InputError("schedule \"table\" needs at least two points [time, pressure], or load.table_file",
                       "load.table");
    }
    for (std::size_t i = 1; i < p.table.size(); ++i) {
      if (!(p.table[i].first > p.table[i - 1].first)) {
        throw InputError("times must increase; point " + std::to_string(i + 1) + " does not", "load.table");
      }
    }
    if (p.repeat) check_period(p);
  } else if (!p.table.empty()) {
    throw InputError("the table is not used unless load.schedule is \"table\"",
                     p.table_file.empty() ? "load.table" : "load.table_file");
  }
}

void resolve_ends(Parameters& p) {
  if (!p.end_length) p.end_length = p.horizon;
  if (p.ends == EndCondition::axial_periodic) {
    if (p.length < 2 * *p.horizon + *p.spacing) {
      throw InputError(
          "a periodic piece must be longer than two horizons, here " + quantity(2 * *p.horizon, "m"),
          "vessel.length");
    }
  }
  p.spots.period = p.ends == EndCondition::axial_periodic ? p.length : INFINITY;
}

/// Throws InputError for what the general engine does not have.
void check_general(const Parameters& p) {
  const auto refuse = [&](bool given, const char* key, const char* instead) {
    if (given) throw InputError("not with material.law = \"" + p.law.name + "\"" + instead, key);
  };
  refuse(p.cross_section != Arrangement::polar, "discretisation.cross_section", "; take \"polar\"");
  refuse(p.surface_correction != SurfaceCorrection::automatic, "discretisation.surface_correction",
         ", whose gradients are exact up to the surface; leave it out");
  refuse(p.ends == EndCondition::axial_periodic, "boundary.ends",
         "; take \"clamped\", \"sliding\" or \"free\"");
  refuse(!p.spots.list.empty(), "spot.position", "");
  refuse(p.scatter.critical_stretch > 0, "scatter.critical_stretch", "");
  refuse(p.scatter.stiffness > 0, "scatter.stiffness", "");
}

}  // namespace

std::vector<std::string> resolve(Parameters& p) {
  if (!(p.outer_radius > p.inner_radius)) {
    throw InputError("the outer radius must be above the inner one, vessel.inner_radius = " +
                         quantity(p.inner_radius, "m"),
                     "vessel.outer_radius");
  }
  if (p.lattice_shift.size() != 2) {
    throw InputError("two numbers are needed, for x and y", "discretisation.lattice_shift");
  }
  if (p.surface_correction == SurfaceCorrection::calibrated && p.cross_section != Arrangement::polar) {
    throw InputError("\"calibrated\" needs discretisation.cross_section = \"polar\"",
                     "discretisation.surface_correction");
  }
  if (p.law.by_gradient()) check_general(p);
  resolve_spacing(p);
  resolve_critical_stretch(p);
  if (!p.law.wall.layers.empty())
    p.young_modulus = 2 * (1 + p.law.poisson_ratio) *
                      std::ranges::max(p.law.wall.layers, {}, &WallLayer::shear_modulus).shear_modulus;
  if (p.length < *p.spacing) throw InputError("the vessel is shorter than one spacing", "vessel.length");
  resolve_load(p);
  if (p.equilibrium_pressure > 0) p.schedule_start = time_of_pressure(p, p.equilibrium_pressure);
  resolve_ends(p);

  const double wall = p.outer_radius - p.inner_radius;
  std::vector<std::string> warnings = resolve(p.scatter, wall, *p.spacing);
  std::ranges::move(check(p.spots, p.length, wall, *p.spacing), std::back_inserter(warnings));
  const double across = wall / *p.spacing;
  if (across < 2.999) {
    warnings.push_back("the wall is " + text(across) +
                       " spacings thick; below 3 its stiffness and strength mean little");
  }
  if (p.inner_radius < *p.horizon) {
    warnings.push_back("the lumen's radius (" + quantity(p.inner_radius, "m") + ") is below the horizon (" +
                       quantity(*p.horizon, "m") +
                       "): its roundness is not resolved, and displacements are off by tens of per cent "
                       "(\"check\" tells how much); take a smaller spacing");
  }
  if (p.law.name == "lps" && p.law.poisson_ratio > 0.45) {
    warnings.push_back("a nearly incompressible wall (material.poisson_ratio = " + text(p.law.poisson_ratio) +
                       ") does not converge with the spacing: \"check\" tells how far it is off");
  }
  if (p.layer == LayerForce::paper && *p.layer_thickness > wall * (1 + 1e-9)) {
    warnings.push_back("the loaded layer (" + quantity(*p.layer_thickness, "m") +
                       ") is thicker than the wall (" + quantity(wall, "m") +
                       "): part of the load falls outside it and is lost");
  }
  if (p.layer == LayerForce::paper && std::ranges::any_of(p.spots.list, [&](const Spot& spot) {
        return spot.thickness < 1 && spot.thickness * wall < *p.layer_thickness;
      })) {
    warnings.push_back("a spot is thinner than the loaded layer (" + quantity(*p.layer_thickness, "m") +
                       "), which loses part of its load there; load.layer = \"consistent\" keeps it");
  }
  return warnings;
}

}  // namespace rhexis::peridynamics
