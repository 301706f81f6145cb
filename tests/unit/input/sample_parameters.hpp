/// Declarations like those of the physics, with one of every type, for the tests of the input.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/parameter.hpp"

namespace rhexis::input {

struct Sample {
  double inner_radius = 0, outer_radius = 0, length = 0;
  double density = 0, young_modulus = 0, critical_stretch = 0;
  std::string cross_section;
  std::optional<double> spacing;
  std::optional<std::int64_t> particles;
  double pressure = 0;
  std::string schedule;
  std::vector<CurvePoint> table;
  std::optional<double> step;
  double end = 0;
  std::int64_t every_steps = 0;
  std::vector<std::string> fields;
  std::vector<double> probes;
  std::vector<std::string> scripts;
  bool movie = false;

  ParameterList parameters() {
    return {
        {"vessel.inner_radius",
         &inner_radius,
         "m",
         {},
         "Inner radius before loading.",
         "Table 1",
         Range::positive()},
        {"vessel.outer_radius", &outer_radius, "m", "\"2 mm\"", "Outer radius before loading.", "Table 1",
         Range::positive()},
        {"vessel.length", &length, "m", "\"20 mm\"", "Length of the segment.", "", Range{0, 1, true, false}},
        {"material.density", &density, "kg/m3", "\"1.3 g/cm3\"", "Mass density of the wall.", "Table 1",
         Range::positive()},
        {"material.young_modulus", &young_modulus, "Pa", "\"1 MPa\"", "Stiffness of the wall.", "Table 1",
         Range::positive()},
        {"material.critical_stretch", &critical_stretch, "1", "0.25", "Stretch at which a bond breaks.",
         "Eq. (4)", Range{0, 10, true, true}},
        {"discretisation.cross_section",
         &cross_section,
         "",
         "\"polar\"",
         "How the cross-section is filled.",
         "",
         {},
         {"lattice", "polar"}},
        {"discretisation.spacing", &spacing, "m", "\"auto\"",
         "Distance between particles; by itself, a sixth of the thickness of the wall, so that three layers "
         "of "
         "bonds fit inside.",
         "", Range::positive()},
        {"discretisation.particles", &particles, "1", "\"auto\"", "Number of particles to aim at.", "",
         Range::at_least(100)},
        {"load.pressure", &pressure, "Pa", "\"238 kPa\"", "Pressure on the inner face.", "Sec. 4.1",
         Range::not_negative()},
        {"load.schedule",
         &schedule,
         "",
         "\"smooth_ramp\"",
         "How the pressure rises.",
         "",
         {},
         {"step", "ramp", "smooth_ramp", "table"}},
        only_with({"load.schedule", {"\"table\""}},
                  {"load.table", &table, "s, Pa", "[]", "Pressure over time.", "", Range::not_negative()}),
        {"time.step", &step, "s", "\"auto\"", "Time step.", "", Range::positive()},
        {"time.end", &end, "s", "\"1 ms\"", "Time to simulate.", "", Range::positive()},
        only_with({"time.step", {}}, {"output.every_steps", &every_steps, "1", "100",
                                      "Steps between outputs.", "", Range::at_least(1)}),
        {"output.fields",
         &fields,
         "",
         "[\"displacement\", \"damage\"]",
         "Fields to store.",
         "",
         {},
         {"displacement", "velocity", "damage"}},
        only_with({"insitu.movie", {"true"}}, {"output.probes", &probes, "m", "[]",
                                               "Axial positions to record.", "", Range::not_negative()}),
        {"insitu.scripts", &scripts, "", "[]", "Catalyst scripts.", ""},
        {"insitu.movie", &movie, "", "true", "Make a movie of the pictures.", ""},
    };
  }
};

}  // namespace rhexis::input
