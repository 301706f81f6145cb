// SPDX-License-Identifier: BSD-3-Clause
// The flat list of keys and values, from files, texts and --set. What is refused is in test_malformed.cpp.
#include "input/document.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/error.hpp"

namespace rhexis::input {
namespace {

/// The value of `time.step` after `--set argument`, as TOML.
std::string override_of(const std::string& argument) {
  const auto document = parse_document("[time]\nstep = \"1 ns\"\nend = 1\n", "a.toml", std::vector{argument});
  const auto entry = std::ranges::find(document.entries, "time.step", &Entry::key);
  EXPECT_FALSE(entry->from_file());
  return written(entry->value);
}

TEST(Document, KeepsTheOrderAndTheLinesOfTheFile) {
  const auto document =
      parse_document("# a comment\n[zebra]\nb = 1\na = 2\n\n[empty]\n[ant]\nc = 3\n", "a.toml");
  std::vector<std::string> places;
  for (const Entry& entry : document.entries) places.push_back(document.place(entry));
  EXPECT_EQ(places, (std::vector<std::string>{"a.toml:3: zebra.b = 1", "a.toml:4: zebra.a = 2",
                                              "a.toml:8: ant.c = 3"}));
  std::vector<std::string> sections;
  for (const Section& section : document.sections) sections.push_back(section.name);
  EXPECT_EQ(sections, (std::vector<std::string>{"zebra", "empty", "ant"}));
  EXPECT_EQ(document.sections[2].line, 7);
  EXPECT_EQ(document.entries[0].column, 1);
}

TEST(Document, ReadsEveryKindOfValue) {
  const std::vector<std::string> values{
      "\"1.5 mm\"",          "10", "0.5", "true", "[\"a\", \"b\"]", "[[\"0 ms\", 1], [\"1 ms\", 2]]", "[]",
      "\"quote \\\" and µ\""};
  for (const std::string& value : values) {
    const auto document = parse_document("[section]\nkey = " + value + "\n", "a.toml");
    ASSERT_EQ(document.entries.size(), 1U);
    EXPECT_EQ(written(document.entries[0].value), value);
  }
}

TEST(Document, InlineAndDottedSectionsAreSections) {
  for (const char* text : {"vessel = {length = 1}", "vessel.length = 1", "[vessel]\nlength = 1"}) {
    const auto document = parse_document(text, "a.toml");
    ASSERT_EQ(document.entries.size(), 1U) << text;
    EXPECT_EQ(document.entries[0].key, "vessel.length");
    EXPECT_EQ(document.sections.size(), 1U);
  }
}

TEST(Document, OverridesNeedNoQuotes) {
  EXPECT_EQ(override_of("time.step=500ns"), "\"500ns\"");
  EXPECT_EQ(override_of("time.step=200 kPa"), "\"200 kPa\"");
  EXPECT_EQ(override_of("time.step = auto "), "\"auto\"");
  EXPECT_EQ(override_of("time.step=\"20 mm\""), "\"20 mm\"");
  EXPECT_EQ(override_of("time.step='20 mm'"), "\"20 mm\"");
  EXPECT_EQ(override_of("time.step=10"), "10");
  EXPECT_EQ(override_of("time.step=2.5e-3"), "0.0025");
  EXPECT_EQ(override_of("time.step=false"), "false");
  EXPECT_EQ(override_of("time.step=[\"a.py\", \"b.py\"]"), "[\"a.py\", \"b.py\"]");
  EXPECT_EQ(override_of("time.step=a=b"), "\"a=b\"");
  EXPECT_EQ(override_of("time.step=1979-05-27"), "\"1979-05-27\"");
  EXPECT_THROW(override_of("time.step=1\nother = 2"), InputError) << "no second key, and no text either";
}

TEST(Document, TheLastOverrideHolds) {
  const auto document =
      parse_document("[a]\nx = 1\n", "a.toml", std::vector<std::string>{"a.x=2", "b.y=3", "a.x=4", "b.y=5"});
  ASSERT_EQ(document.entries.size(), 2U);
  EXPECT_EQ(document.place(document.entries[0]), "--set a.x=4");
  EXPECT_EQ(document.place(document.entries[1]), "--set b.y=5");
}

TEST(Document, LongValuesAreCutInMessages) {
  std::string list = "[0";
  for (int i = 1; i < 1000; ++i) list += ", " + std::to_string(i);
  const auto document = parse_document("[a]\nx = " + list + "]\n", "a.toml");
  const std::string place = document.place(document.entries[0]);
  EXPECT_TRUE(place.starts_with("a.toml:2: a.x = [0, 1, 2, "));
  EXPECT_TRUE(place.ends_with("..."));
  EXPECT_LT(place.size(), 120U);
}

class Files : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  static std::string problem_of(const std::filesystem::path& file) {
    try {
      read_text(file);
      return "was read";
    } catch (const InputError& error) {
      return error.what();
    }
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("rhexis_test_document_" + std::to_string(getpid()));
};

TEST_F(Files, AreReadWhole) {
  const std::string text = "[a]\r\nx = \"µm\"\n";
  EXPECT_EQ(read_text(write("a.toml", text)), text);
  EXPECT_EQ(read_text(write("empty.toml", "")), "");
}

TEST_F(Files, RefusalsNameTheFile) {
  const auto missing = folder_ / "missing.toml";
  EXPECT_EQ(problem_of(missing), missing.string() + ": cannot be read: No such file or directory");
  EXPECT_EQ(problem_of(folder_), folder_.string() + ": this is a folder; give an input file (TOML)");
  EXPECT_NE(problem_of(write("big.toml", std::string(65'000'000, '#'))).find("65 MB, too large"),
            std::string::npos);
}

TEST_F(Files, AnUnreadableFileSaysWhy) {
  if (geteuid() == 0) GTEST_SKIP() << "root reads everything";
  const auto file = write("secret.toml", "");
  std::filesystem::permissions(file, std::filesystem::perms::none);
  EXPECT_NE(problem_of(file).find("Permission denied"), std::string::npos);
}

}  // namespace
}  // namespace rhexis::input
