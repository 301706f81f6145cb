// SPDX-License-Identifier: BSD-3-Clause
// Sections that may stand any number of times, [[mark]]: each fills one element of a list.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "input/keys.hpp"
#include "input/reader.hpp"

namespace rhexis::input {
namespace {

struct Mark {
  double position = 0, angle = 0, factor = 1;
};

struct Marks {
  double length = 0.02;
  std::vector<Mark> list;

  ParameterList parameters() {
    return {
        {.key = "vessel.length",
         .target = &length,
         .unit = "m",
         .default_in = "mm",
         .meaning = "Length of the segment.",
         .range = Range::positive()},
        {.key = "mark.position",
         .target = ListTarget(&list, &Mark::position),
         .unit = "m",
         .meaning = "Where it is.",
         .range = Range::not_negative(),
         .required = true},
        {.key = "mark.angle",
         .target = ListTarget(&list, &Mark::angle),
         .unit = "rad",
         .default_in = "deg",
         .meaning = "Around the axis."},
        {.key = "mark.factor",
         .target = ListTarget(&list, &Mark::factor),
         .unit = "1",
         .meaning = "How much.",
         .range = Range::positive()},
    };
  }
};

constexpr const char* two = R"([vessel]
length = "10 mm"

[[mark]]
position = "1 mm"
factor = 0.5

[[mark]]
position = "2 mm"
angle = "180 deg"
)";

Resolved read_into(Marks& marks, const std::string& text, const std::vector<std::string>& overrides = {}) {
  return read(parse_document(text, "a.toml", overrides), marks.parameters());
}

std::string refusal(const std::string& text, const std::vector<std::string>& overrides = {}) {
  Marks marks;
  try {
    read_into(marks, text, overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing refused";
}

TEST(Repeated, EachTableGivesOneNumberOrItsDefault) {
  Marks marks;
  read_into(marks, two);
  ASSERT_EQ(marks.list.size(), 2U);
  EXPECT_EQ(marks.list[0].position, 1e-3);
  EXPECT_EQ(marks.list[1].position, 2e-3);
  EXPECT_EQ(marks.list[0].factor, 0.5);
  EXPECT_EQ(marks.list[1].factor, 1);
  EXPECT_EQ(marks.list[0].angle, 0);
  EXPECT_NEAR(marks.list[1].angle, 3.141592653589793, 1e-15);
}

TEST(Repeated, MayBeAbsentAndInline) {
  Marks marks;
  read_into(marks, two);
  read_into(marks, "");
  EXPECT_TRUE(marks.list.empty());
  read_into(marks, "mark = [{position = \"3 mm\"}]\n");
  ASSERT_EQ(marks.list.size(), 1U);
  EXPECT_EQ(marks.list[0].position, 3e-3);
}

TEST(Repeated, TheRecordAndTheCommandLineNumberTheTables) {
  Marks marks;
  const Resolved resolved = read_into(marks, two, {"mark[2].factor=3"});
  EXPECT_EQ(marks.list[0].factor, 0.5);
  EXPECT_EQ(marks.list[1].factor, 3);
  const auto json = to_json(resolved);
  EXPECT_EQ(json["mark[1]"]["position"]["value"], 1e-3);
  EXPECT_EQ(json["mark[2]"]["angle"]["written"], "180 deg");
  EXPECT_EQ(json["mark[2]"]["factor"]["origin"], "--set");
  EXPECT_STREQ(located(InputError("too far", "mark[2].position"), resolved).what(),
               "a.toml:9: mark[2].position = \"2 mm\": too far");
}

TEST(Repeated, ErrorsNameTheTableAndItsLine) {
  const std::string header = "[[mark]]\nposition = \"1 mm\"\n[[mark]]\n";
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases{
      {header + "position = \"-1 mm\"\n", {"a.toml:4: mark[2].position", "at least 0"}},
      {header + "position = 2\n", {"a.toml:4: mark[2].position", "unit"}},
      {header + "positoin = \"1 mm\"\n",
       {"a.toml:4: mark[2].positoin", "did you mean mark[2].position?", "'rhexis keys mark'"}},
      {header, {"a.toml: mark[2].position is missing", "under its [[mark]] write"}},
      {"[mark]\nposition = \"1 mm\"\n", {"a.toml:1", "write [[mark]]"}},
      {"[[vessel]]\nlength = \"1 mm\"\n", {"a.toml:1", "[[vessel]]", "write [vessel], once"}},
      {"[[mrak]]\n", {"a.toml:1", "no section 'mrak'", "did you mean mark?"}},
      {"[[mark]]\nposition = \"1 mm\"\n[mark.more]\nx = 1\n", {"unexpected table", "mark[1].more"}}};
  for (const auto& [text, parts] : cases) {
    const std::string message = refusal(text);
    for (const std::string& part : parts) EXPECT_NE(message.find(part), std::string::npos) << message;
  }
  EXPECT_NE(refusal(two, {"mark[3].factor=3"}).find("no such key"), std::string::npos);
  EXPECT_NE(refusal(two, {"mark.factor=3"}).find("did you mean mark[1].factor?"), std::string::npos)
      << refusal(two, {"mark.factor=3"});
}

TEST(Repeated, KeysShowWhatOneTableTakes) {
  Marks marks;
  const std::string text = describe_keys(marks.parameters(), "mark");
  EXPECT_NE(text.find("\n[[mark]]"), std::string::npos) << text;
  EXPECT_NE(text.find("position  length [m]"), std::string::npos) << text;
  EXPECT_NE(text.find("required, e.g. \"1.5 mm\"; allowed: at least 0 m"), std::string::npos) << text;
  EXPECT_NE(text.find("angle     angle [rad]"), std::string::npos) << text;
}

}  // namespace
}  // namespace rhexis::input
