// SPDX-License-Identifier: BSD-3-Clause
// The reference that `rhexis keys` prints.
#include "input/keys.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "core/error.hpp"
#include "input/catalogue.hpp"
#include "input/description.hpp"
#include "input/document.hpp"
#include "input/reader.hpp"
#include "input/units.hpp"
#include "input/values.hpp"
#include "sample_parameters.hpp"

namespace rhexis::input {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(Keys, OneSectionReadsAsATable) {
  Sample sample;
  const std::string text = describe_keys(sample.parameters(), "discretisation");
  const std::string expected = R"(
[discretisation]
  cross_section     text                 default "polar"; allowed: "lattice", "polar"
                    How the cross-section is filled.
  spacing           length [m]           default "auto"; allowed: greater than 0 m, or "auto"
                    Distance between particles; by itself, a sixth of the thickness of the wall, so
                    that three layers of bonds fit inside.
  particles         whole number         default "auto"; allowed: at least 100, or "auto"
                    Number of particles to aim at.
)";
  EXPECT_EQ(text.substr(text.find("\n[")), expected);
}

TEST(Keys, SayWhatIsRequiredAndWhereItIsFrom) {
  Sample sample;
  const std::string text = describe_keys(sample.parameters(), "vessel");
  EXPECT_NE(text.find("required, e.g. \"1.5 mm\"; allowed: greater than 0 m\n"), std::string::npos) << text;
  EXPECT_NE(text.find("Inner radius before loading. (Table 1)\n"), std::string::npos) << text;
}

TEST(Keys, OneAloneMayBeAskedFor) {
  Sample sample;
  const std::string text = describe_keys(sample.parameters(), "vessel.inner_radius");
  EXPECT_NE(text.find("\n[vessel]\n  inner_radius "), std::string::npos) << text;
  EXPECT_EQ(text.find("\n  length "), std::string::npos) << text;
}

TEST(Keys, SayWhereTheyHaveNoEffect) {
  Sample sample;
  const auto expect = [&](const char* section, const std::string& line) {
    const std::string text = describe_keys(sample.parameters(), section);
    EXPECT_NE(text.find(line + "\n"), std::string::npos) << text;
  };
  expect("load", "Pressure over time. Only with load.schedule = \"table\".");
  expect("output", "Steps between outputs. Only with time.step.");
}

TEST(Keys, EverySectionAndKeyIsThereInOrder) {
  Sample sample;
  const std::string text = describe_keys(sample.parameters());
  std::size_t at = 0;
  for (const char* heading : {"\n[vessel]\n", "\n[material]\n", "\n[load]\n", "\n[time]\n", "\n[insitu]\n"}) {
    const auto next = text.find(heading);
    ASSERT_NE(next, std::string::npos) << heading;
    EXPECT_GT(next, at);
    at = next;
  }
  for (const Parameter& parameter : sample.parameters()) {
    const std::string name = parameter.key.substr(parameter.key.find('.') + 1);
    EXPECT_NE(text.find("  " + name + " "), std::string::npos) << name;
    EXPECT_NE(text.find(parameter.meaning.substr(0, 20)), std::string::npos);
  }
}

TEST(Keys, LinesFitATerminal) {
  Sample sample;
  for (const std::string& line : lines_of(describe_keys(sample.parameters())))
    EXPECT_LE(line.size(), 100U) << line;
}

TEST(Keys, AnUnknownSectionListsTheSections) {
  Sample sample;
  try {
    describe_keys(sample.parameters(), "vesel");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "there is no section 'vesel'; did you mean vessel? (sections: vessel, material, discretisation, "
        "load, time, output, insitu)");
  }
}

TEST(Keys, ExamplesAreAcceptedByTheirOwnKeys) {
  Sample sample;
  for (const Parameter& parameter : sample.parameters()) {
    const std::string override_text = parameter.key + "=" + example(parameter);
    const auto document =
        parse_document("", "a.toml", std::vector<std::string>{"vessel.inner_radius=1 mm", override_text});
    EXPECT_NO_THROW(read(document, sample.parameters())) << override_text;
  }
}

TEST(Keys, DefaultsAreWrittenAsTheirKeysReadThem) {
  Sample sample;
  const ParameterList parameters = sample.parameters();
  const auto shown = [&](const char* key) { return written(default_value(*find(parameters, key))); };
  EXPECT_EQ(shown("vessel.outer_radius"), "\"2 mm\"");
  EXPECT_EQ(shown("material.density"), "\"1.3 g/cm3\"");
  EXPECT_EQ(shown("material.critical_stretch"), "0.25");
  EXPECT_EQ(shown("discretisation.cross_section"), "\"polar\"");
  EXPECT_EQ(shown("discretisation.particles"), "\"auto\"");
  EXPECT_EQ(shown("load.table"), "[]");
  EXPECT_EQ(shown("output.every_steps"), "100");
  EXPECT_EQ(shown("output.fields"), "[\"displacement\", \"damage\"]");
  EXPECT_EQ(shown("insitu.movie"), "true");
  // A number with more digits than people write, in a unit that is no power of ten.
  sample.end = 0.1 + 0.2;
  EXPECT_EQ(to_si(written_in("min", sample.end, "s"), "s"), sample.end);
}

TEST(Keys, ExamplesFitUnusualRanges) {
  double target = 0;
  std::int64_t whole = 0;
  EXPECT_EQ(example({.key = "a.b", .target = &target, .unit = "m", .range = Range::between(5, 7)}),
            "\"6 m\"");
  EXPECT_EQ(example({.key = "a.b", .target = &target, .unit = "1", .range = {.upper = -2}}), "-3");
  EXPECT_EQ(example({.key = "a.b", .target = &whole, .unit = "1", .range = Range::at_least(100)}), "101");
}

}  // namespace
}  // namespace rhexis::input
