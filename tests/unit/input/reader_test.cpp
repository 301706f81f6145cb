// SPDX-License-Identifier: BSD-3-Clause
// From a document to typed values in SI, the record of the run, and errors of the physics put in their place.
#include "input/reader.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "sample_parameters.hpp"

namespace rhexis::input {
namespace {

constexpr const char* everything = R"(
[vessel]
inner_radius = "1.5 mm"
length = "30 mm"

[material]
critical_stretch = "20 %"

[discretisation]
cross_section = "lattice"
spacing = "100 um"
particles = 1e6

[load]
schedule = "table"
table = [["0 ms", "0 kPa"], ["1 ms", "100 kPa"]]

[time]
step = "auto"

[output]
every_steps = 50
fields = ["damage"]
probes = ["0 mm", "15 mm"]

[insitu]
scripts = ["a.py", "b.py"]
movie = false
)";

Resolved read_text_into(Sample& sample, const std::string& text,
                        const std::vector<std::string>& overrides = {}) {
  return read(parse_document(text, "a.toml", overrides), sample.parameters());
}

TEST(Reader, FillsEveryTypeInSi) {
  Sample sample;
  sample.step = 1;  // "auto" must empty it
  read_text_into(sample, everything);
  EXPECT_EQ(sample.inner_radius, 0.0015);
  EXPECT_EQ(sample.length, 0.03);
  EXPECT_EQ(sample.critical_stretch, 0.2);
  EXPECT_EQ(sample.cross_section, CrossSection::lattice);
  EXPECT_EQ(sample.spacing, 1e-4);
  EXPECT_EQ(sample.particles, 1000000);
  EXPECT_EQ(sample.table, (std::vector<CurvePoint>{{0, 0}, {1e-3, 1e5}}));
  EXPECT_EQ(sample.step, std::nullopt);
  EXPECT_EQ(sample.every_steps, 50);
  EXPECT_EQ(sample.fields, std::vector<std::string>{"damage"});
  EXPECT_EQ(sample.probes, (std::vector<double>{0, 0.015}));
  EXPECT_EQ(sample.scripts, (std::vector<std::string>{"a.py", "b.py"}));
  EXPECT_FALSE(sample.movie);
}

TEST(Reader, WhatIsNotGivenKeepsItsDefault) {
  Sample sample;
  read_text_into(sample, "[vessel]\ninner_radius = \"1 mm\"\n");
  EXPECT_EQ(sample.outer_radius, 0.002);
  EXPECT_EQ(sample.density, 1300);
  EXPECT_EQ(sample.critical_stretch, 0.25);
  EXPECT_EQ(sample.cross_section, CrossSection::polar);
  EXPECT_EQ(sample.spacing, std::nullopt);
  EXPECT_EQ(sample.schedule, "smooth_ramp");
  EXPECT_EQ(sample.fields, (std::vector<std::string>{"displacement", "damage"}));
  EXPECT_TRUE(sample.table.empty());
  EXPECT_TRUE(sample.movie);
}

TEST(Reader, OverridesReplaceAndAdd) {
  Sample sample;
  const auto resolved =
      read_text_into(sample, everything,
                     {"vessel.length=10 mm", "time.step=2ns", "time.end=3 ms", "vessel.outer_radius=3 mm"});
  EXPECT_EQ(sample.length, 0.01);
  EXPECT_DOUBLE_EQ(*sample.step, 2e-9);
  EXPECT_EQ(sample.end, 3e-3);
  EXPECT_EQ(sample.outer_radius, 3e-3);
}

TEST(Reader, WarnsOfKeysWithoutEffect) {
  Sample sample;
  const Resolved resolved = read_text_into(sample, everything, {"load.schedule=ramp"});
  EXPECT_EQ(resolved.warnings,
            (std::vector<std::string>{
                R"(a.toml:16: load.table = [["0 ms", "0 kPa"], ["1 ms", "100 kPa"]]: has no effect where )"
                R"(load.schedule = "ramp", only with "table")",
                R"(a.toml:24: output.probes = ["0 mm", "15 mm"]: has no effect where insitu.movie = false, )"
                R"(only with true)"}));
  EXPECT_EQ(read_text_into(sample, "[vessel]\ninner_radius = \"1 mm\"\n[output]\nevery_steps = 3\n").warnings,
            std::vector<std::string>{"a.toml:4: output.every_steps = 3: has no effect without time.step"});
  // Defaults are nobody's mistake.
  EXPECT_TRUE(read_text_into(sample, "[vessel]\ninner_radius = \"1 mm\"\n").warnings.empty());
  EXPECT_TRUE(read_text_into(sample, everything, {"insitu.movie=true"}).warnings.empty());
}

TEST(Reader, OneEndOfARangeMayBeReached) {
  Sample sample;
  read_text_into(sample, everything, {"vessel.length=1 m", "load.pressure=0 Pa", "output.every_steps=1"});
  EXPECT_EQ(sample.length, 1);
  EXPECT_EQ(sample.pressure, 0);
}

TEST(Reader, TheRecordHoldsEveryKey) {
  Sample sample;
  const auto json = to_json(read_text_into(sample, everything, {"time.end=2 ms"}));
  using Json = nlohmann::ordered_json;
  EXPECT_EQ(json["vessel"]["inner_radius"],
            Json::parse(R"({"written": "1.5 mm", "value": 0.0015, "unit": "m", "origin": "file"})"));
  EXPECT_EQ(json["vessel"]["outer_radius"],
            Json::parse(R"({"written": "2 mm", "value": 0.002, "unit": "m", "origin": "default"})"));
  EXPECT_EQ(json["time"]["end"],
            Json::parse(R"({"written": "2 ms", "value": 0.002, "unit": "s", "origin": "--set"})"));
  EXPECT_EQ(json["time"]["step"]["written"], "auto");
  EXPECT_TRUE(json["time"]["step"]["value"].is_null());
  EXPECT_EQ(json["load"]["table"]["value"], Json::parse("[[0.0, 0.0], [0.001, 100000.0]]"));
  EXPECT_EQ(json["load"]["table"]["written"], Json::parse(R"([["0 ms", "0 kPa"], ["1 ms", "100 kPa"]])"));
  EXPECT_EQ(json["discretisation"]["particles"]["value"], 1000000);
  EXPECT_EQ(json["insitu"]["movie"]["value"], false);
  EXPECT_EQ(json.begin().key(), "vessel");
  std::size_t keys = 0;
  for (const auto& section : json) keys += section.size();
  EXPECT_EQ(keys, sample.parameters().size());
}

TEST(Reader, ProblemsOfThePhysicsGetTheirPlace) {
  Sample sample;
  const auto resolved = read_text_into(sample, everything, {"time.end=2 ms"});
  const auto message = [&resolved](const std::string& key) {
    const InputError error = located(InputError("must be larger", key), resolved);
    EXPECT_EQ(error.key, key);
    return std::string(error.what());
  };
  EXPECT_EQ(message("vessel.inner_radius"), "a.toml:3: vessel.inner_radius = \"1.5 mm\": must be larger");
  EXPECT_EQ(message("vessel.outer_radius"), "a.toml: vessel.outer_radius (default \"2 mm\"): must be larger");
  EXPECT_EQ(message("time.end"), "--set time.end=2 ms: must be larger");
  EXPECT_EQ(message("coupling"), "a.toml: coupling: must be larger");
  EXPECT_EQ(message(""), "a.toml: must be larger");
}

}  // namespace
}  // namespace rhexis::input
