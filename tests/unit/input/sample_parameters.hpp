// SPDX-License-Identifier: BSD-3-Clause
/// Declarations like those of the physics, with one of every type, for the tests of the input.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/parameter.hpp"

namespace rhexis::input {

enum class CrossSection { lattice, polar };

constexpr auto name_table(CrossSection) {
  using enum CrossSection;
  return std::to_array<Named<CrossSection>>({{lattice, "lattice"}, {polar, "polar"}});
}

struct Sample {
  double inner_radius = 0, outer_radius = 2e-3, length = 0.02;
  double density = 1300, young_modulus = 1e6, critical_stretch = 0.25;
  CrossSection cross_section = CrossSection::polar;
  std::optional<double> spacing;
  std::optional<std::int64_t> particles;
  double pressure = 238e3;
  std::string schedule = "smooth_ramp";
  std::vector<CurvePoint> table;
  std::optional<double> step;
  double end = 1e-3;
  std::int64_t every_steps = 100;
  std::vector<std::string> fields{"displacement", "damage"};
  std::vector<double> probes;
  std::vector<std::string> scripts;
  bool movie = true;

  ParameterList parameters() {
    return {
        {.key = "vessel.inner_radius",
         .target = &inner_radius,
         .unit = "m",
         .meaning = "Inner radius before loading.",
         .source = "Table 1",
         .range = Range::positive(),
         .required = true},
        {.key = "vessel.outer_radius",
         .target = &outer_radius,
         .unit = "m",
         .default_in = "mm",
         .meaning = "Outer radius before loading.",
         .source = "Table 1",
         .range = Range::positive()},
        {.key = "vessel.length",
         .target = &length,
         .unit = "m",
         .default_in = "mm",
         .meaning = "Length of the segment.",
         .range = Range{0, 1, true, false}},
        {.key = "material.density",
         .target = &density,
         .unit = "kg/m3",
         .default_in = "g/cm3",
         .meaning = "Mass density of the wall.",
         .source = "Table 1",
         .range = Range::positive()},
        {.key = "material.young_modulus",
         .target = &young_modulus,
         .unit = "Pa",
         .default_in = "MPa",
         .meaning = "Stiffness of the wall.",
         .source = "Table 1",
         .range = Range::positive()},
        {.key = "material.critical_stretch",
         .target = &critical_stretch,
         .unit = "1",
         .meaning = "Stretch at which a bond breaks.",
         .source = "Eq. (4)",
         .range = Range{0, 10, true, true}},
        {.key = "discretisation.cross_section",
         .target = &cross_section,
         .meaning = "How the cross-section is filled."},
        {.key = "discretisation.spacing",
         .target = &spacing,
         .unit = "m",
         .meaning = "Distance between particles; by itself, a sixth of the thickness of the wall, so that "
                    "three layers of bonds fit inside.",
         .range = Range::positive()},
        {.key = "discretisation.particles",
         .target = &particles,
         .unit = "1",
         .meaning = "Number of particles to aim at.",
         .range = Range::at_least(100)},
        {.key = "load.pressure",
         .target = &pressure,
         .unit = "Pa",
         .default_in = "kPa",
         .meaning = "Pressure on the inner face.",
         .source = "Sec. 4.1",
         .range = Range::not_negative()},
        {.key = "load.schedule",
         .target = &schedule,
         .meaning = "How the pressure rises.",
         .choices = {"step", "ramp", "smooth_ramp", "table"}},
        {.key = "load.table",
         .target = &table,
         .unit = "s, Pa",
         .meaning = "Pressure over time.",
         .range = Range::not_negative(),
         .only_with = {{"load.schedule", {"\"table\""}}}},
        {.key = "time.step",
         .target = &step,
         .unit = "s",
         .meaning = "Time step.",
         .range = Range::positive()},
        {.key = "time.end",
         .target = &end,
         .unit = "s",
         .default_in = "ms",
         .meaning = "Time to simulate.",
         .range = Range::positive()},
        {.key = "output.every_steps",
         .target = &every_steps,
         .unit = "1",
         .meaning = "Steps between outputs.",
         .range = Range::at_least(1),
         .only_with = {{"time.step", {}}}},
        {.key = "output.fields",
         .target = &fields,
         .meaning = "Fields to store.",
         .choices = {"displacement", "velocity", "damage"}},
        {.key = "output.probes",
         .target = &probes,
         .unit = "m",
         .meaning = "Axial positions to record.",
         .range = Range::not_negative(),
         .only_with = {{"insitu.movie", {"true"}}}},
        {.key = "insitu.scripts", .target = &scripts, .meaning = "Catalyst scripts."},
        {.key = "insitu.movie", .target = &movie, .meaning = "Make a movie of the pictures."},
    };
  }
};

}  // namespace rhexis::input
