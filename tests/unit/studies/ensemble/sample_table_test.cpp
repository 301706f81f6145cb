// SPDX-License-Identifier: BSD-3-Clause
#include "studies/ensemble/sample_table.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"

namespace rhexis::ensemble {
namespace {

const std::vector<Sample> samples{{.pressure = 13332.238741500001,
                                   .wall = 0,
                                   .factors = {0.1, 1.0 / 3, 1},
                                   .max_displacement = 1e-5,
                                   .steps = 7},
                                  {.pressure = 2e4,
                                   .wall = 999999,
                                   .factors = {1, 1.1, 0.9},
                                   .ruptured = true,
                                   .onset = 1.0 / 700,
                                   .first_break = 1e-9,
                                   .max_displacement = 4e-5,
                                   .steps = 1009}};

std::string table() {
  return sample_header + row(samples[0]) + row(samples[1]);
}

std::string message(const std::string& text) {
  try {
    read_samples(text, "samples.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SampleTable, ReadsBackWhatItWrote) {
  EXPECT_EQ(read_samples(table(), "samples.csv"), samples);
}

TEST(SampleTable, DropsALineThatACrashCutShort) {
  const std::string text = table();
  const std::size_t whole = text.size(), second = row(samples[1]).size(),
                    header = std::string(sample_header).size();
  for (std::size_t size = 0; size <= whole; ++size) {
    const std::size_t rows = size == whole ? 2 : size >= whole - second ? 1 : 0;
    EXPECT_EQ(read_samples(text.substr(0, size), "samples.csv").size(), size < header ? 0 : rows) << size;
  }
}

TEST(SampleTable, NamesFileAndLineOfWhatIsNoSample) {
  EXPECT_NE(message("step,time_s\n").find("samples.csv:1"), std::string::npos);
  std::string header = sample_header;
  for (const char* line :
       {"1,2,3", "1,0,1,1,1,2,,,0,5", "1,0,1,1,1,1,,,0,5", "1,0,1,1,1,0,,,0,5,6", "1,0,1,1,1,0,,,x,5",
        "1,0,1,1,1,0,,,0,", "1,0.5,1,1,1,0,,,0,5", "", "inf,0,1,1,1,0,,,0,5", "1,0,nan,1,1,0,,,0,5",
        "1,0,1,-1,1,0,,,0,5", "1,-1,1,1,1,0,,,0,5", "1,0,1,1,1,0,,,0,-5", "1,0,1,1,1,1,-1,,0,5",
        "1,0,1,1,1,0,,,1e999,5"}) {
    EXPECT_NE(message(header + row(samples[0]) + line + "\n").find("samples.csv:3"), std::string::npos)
        << line;
  }
  EXPECT_EQ(message(header + "1,0,1,1,1,0,,,0,5\n"), "");
  EXPECT_EQ(message(table() + row(samples[0])),
            "samples.csv:4: a second sample of wall 0 under 13332.238741500001 Pa");
}

}  // namespace
}  // namespace rhexis::ensemble
