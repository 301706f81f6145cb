// SPDX-License-Identifier: BSD-3-Clause
// Units at the door. Tolerance: 4 units in the last place (conversion by factors that are not whole), else
// exact.
#include "input/units.hpp"

#include <gtest/gtest.h>

#include <string>

#include "core/error.hpp"

namespace rhexis::input {
namespace {

struct Conversion {
  const char* text;
  const char* unit;
  double expected;
};

void PrintTo(const Conversion& c, std::ostream* out) {
  *out << c.text << " in " << c.unit;
}

class Converts : public testing::TestWithParam<Conversion> {};

TEST_P(Converts, ToSi) {
  EXPECT_DOUBLE_EQ(to_si(GetParam().text, GetParam().unit), GetParam().expected);
}

INSTANTIATE_TEST_SUITE_P(
    Units, Converts,
    testing::Values(Conversion{"1.5 mm", "m", 0.0015}, Conversion{"238 kPa", "Pa", 238e3},
                    Conversion{"1785 mmHg", "Pa", 1785 * 133.322387415},
                    Conversion{"1.3 g/cm3", "kg/m3", 1300}, Conversion{"500 ns", "s", 5e-7},
                    Conversion{"500ns", "s", 5e-7}, Conversion{"2.25e-3 s", "s", 2.25e-3},
                    Conversion{"25 %", "1", 0.25}, Conversion{"0.25", "1", 0.25},
                    Conversion{"100 \u00b5m", "m", 1e-4}, Conversion{"100 \u03bcm", "m", 1e-4},
                    Conversion{"37 degC", "K", 310.15}, Conversion{" +1.5  mm ", "m", 0.0015},
                    Conversion{"-3 um", "m", -3e-6}, Conversion{"3.5 cP", "Pa s", 3.5e-3},
                    Conversion{"10 dyn/cm2", "Pa", 1}, Conversion{"5 L/min", "m3/s", 5e-3 / 60},
                    Conversion{"70 1/min", "1/s", 70. / 60}, Conversion{"1 mm^2", "m2", 1e-6},
                    Conversion{"2 m5", "m5", 2}));

TEST(Units, StandardGravity) {
  for (const char* unit : {"g0", "gravity", "standard_free_fall"})
    EXPECT_DOUBLE_EQ(to_si(std::string("-2 ") + unit, "m/s2"), -2 * 9.80665) << unit;
}

TEST(Units, RoundFactorsAreExact) {
  // Lattices are counted with these: 2 mm / 100 um must be 20, not 20.000000000000004.
  EXPECT_EQ(to_si("100 um", "m"), 1e-4);
  EXPECT_EQ(to_si("1.3 g/cm3", "kg/m3"), 1300.0);
  EXPECT_EQ(to_si("0.3 mm", "m"), 3e-4);
}

struct Refusal {
  const char* text;
  const char* unit;
  std::vector<const char*> fragments;
};

void PrintTo(const Refusal& r, std::ostream* out) {
  *out << '"' << r.text << "\" in " << r.unit;
}

class Refuses : public testing::TestWithParam<Refusal> {};

TEST_P(Refuses, WithAReason) {
  const Refusal& refusal = GetParam();
  try {
    const double value = to_si(refusal.text, refusal.unit);
    FAIL() << "was read as " << value;
  } catch (const InputError& error) {
    for (const char* fragment : refusal.fragments)
      EXPECT_NE(std::string(error.what()).find(fragment), std::string::npos)
          << "no '" << fragment << "' in: " << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Units, Refuses,
    testing::Values(
        Refusal{"1.5", "m", {"a unit is missing", "\"1.5 mm\""}},
        Refusal{"238 kg",
                "Pa",
                {"'kg' measures a mass", "a pressure is expected", "\"238 kPa\"", "\"238 mmHg\""}},
        Refusal{"3 Hz", "s", {"'Hz' measures a rate", "a time is expected"}},
        Refusal{"3 kg", "1", {"'kg' measures a mass", "a plain number is expected", "25 %"}},
        Refusal{"3 cd", "m", {"'cd' is a unit of something else", "a length is expected"}},
        Refusal{"1 s since 2000-01-01", "s", {"more than one number"}},
        Refusal{"238 kpa", "Pa", {"'kpa' is not a known unit", "\"238 kPa\""}},
        Refusal{"1 mm/", "m", {"'mm/' is not a known unit"}},
        Refusal{"abc mm", "m", {"does not begin with a number", "a length", "\"1.5 mm\""}},
        Refusal{"", "m", {"does not begin with a number"}}, Refusal{"nan mm", "m", {"'nan' is not a finite"}},
        Refusal{"-inf s", "s", {"'-inf' is not a finite number"}},
        Refusal{"1e400 m", "m", {"'1e400' is not a finite"}}, Refusal{"1e308 km", "m", {"too large"}},
        Refusal{"1,5 mm", "m", {"decimal comma"}}, Refusal{"1 000 mm", "m", {"more than one number"}},
        Refusal{"5 mm 3", "m", {"more than one number"}}, Refusal{"5 mm -3", "m", {"more than one number"}},
        Refusal{"3 mm*2", "m", {"more than one number"}}, Refusal{"3 mm.2", "m", {"more than one number"}},
        Refusal{"3 mm/0.5", "m", {"more than one number"}},
        Refusal{"3 (2 mm)", "m", {"more than one number"}}));

TEST(Units, AnUnknownUnitInADeclarationIsNotTheUsersFault) {
  EXPECT_THROW(to_si("1 mm", "metres_of_rope"), std::logic_error);
}

TEST(Units, ExamplesAreValid) {
  for (const char* unit :
       {"m", "s", "kg", "K", "Pa", "kg/m3", "m3/s", "Pa s", "1/s", "N", "J", "W", "1", "m5"})
    EXPECT_NO_THROW(to_si(example_quantity(unit), unit)) << unit;
}

TEST(Units, Names) {
  EXPECT_EQ(measured_by("Pa"), "a pressure");
  EXPECT_EQ(measured_by("1"), "a plain number");
  EXPECT_EQ(measured_by("m5"), "a value in m5");
  EXPECT_EQ(with_unit(0.0015, "m"), "0.0015 m");
  EXPECT_EQ(with_unit(0.25, "1"), "0.25");
}

}  // namespace
}  // namespace rhexis::input
