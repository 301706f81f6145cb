// SPDX-License-Identifier: BSD-3-Clause
// Tables as spreadsheets of any country and system write them: one table in many guises, and what is refused.
#include "core/csv_table.hpp"

#include <gtest/gtest.h>

namespace rhexis {
namespace {

double to_si(std::string_view text, std::string_view unit) {
  if (text == "1 um" && unit == "m") return 1e-6;
  if (text == "1 \xc2\xb5m" && unit == "m") return 1e-6;
  if (text == "1 m" && unit == "m") return 1;
  throw InputError("no such unit");
}

const Columns columns{{"id", ""}, {"wall_thickness", "m", {"WallAvg"}}, {"share", "1"}};
const std::string plain = "id,wall_thickness [um],share\na b,1.5,0.25\n7,-20,\n";

std::string utf16(const std::string& ascii, bool big_endian) {
  std::string bytes = big_endian ? "\xfe\xff" : "\xff\xfe";
  for (const char c : ascii) bytes += big_endian ? std::string{'\0', c} : std::string{c, '\0'};
  return bytes;
}

/// All that the rows hold, and which columns are skipped.
std::string read(const std::string& text, CsvOptions options = {.skips_other_columns = true}) {
  try {
    CsvTable table("t.csv", text, columns, to_si, std::move(options));
    std::string all;
    while (table.next()) {
      all += std::to_string(table.line()) + ":" + table.text("id");
      for (const char* name : {"wall_thickness", "share"})
        if (const auto number = table.number(name))
          all += "|" + std::to_string(*number * (*name == 'w' ? 1e6 : 1));
      all += ";";
    }
    for (const std::string& heading : table.skipped()) all += " skipped " + heading;
    return all;
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(CsvTable, ReadsOneTableInManyGuises) {
  const std::string expected = "2:a b|1.500000|0.250000;3:7|-20.000000;";
  std::string cr = plain;
  std::replace(cr.begin(), cr.end(), '\n', '\r');
  for (const std::string& text : {
           plain,
           std::string("ID,Wall Thickness (um),Share\r\n\"a b\",1.5,0.25\r\n7,-20,\r\n"),
           std::string("id;wall-thickness [um];share\na b;1,5;0,25\n7;-20;\n"),
           std::string("id;WALLAVG [um];share\na b;1.5;0.25\n7;-2e1;\n"),
           std::string("id\twall_thickness [um]\tshare\na b\t1,5\t0,25\n7\t-20\t\n"),
           std::string("id,wall_thickness [\xc2\xb5m],share [%]\na b,1.5,25\n7,-20,\n"),
           std::string("id,wall_thickness [um],share,,\na b,1.5,0.25,,\n7,-20,,,\n"),
           "\xef\xbb\xbf" + plain,
           std::string("id,wall_thickness [\xb5m],share [%]\na b,1.5,25\n7,-20,\n"),  // Latin 1
           utf16(plain, false),
           utf16(plain, true),
           cr,
       })
    EXPECT_EQ(read(text), expected) << text;
  EXPECT_EQ(read("sep=;\nid;share\na;0,25\n"), "3:a|0.250000;");
  EXPECT_EQ(read("id,share\n,,\na,1\n , \n"), "3:a|1.000000;");
}

TEST(CsvTable, SkipsOtherColumnsWhereAskedTo) {
  EXPECT_EQ(read("degree,id,note [x\n3,a,b\n"), "2:a; skipped degree skipped note [x");
  EXPECT_EQ(read("degree,id\n3,a\n", {}),
            "t.csv:1: there is no column 'degree' (columns: id, wall_thickness, share)");
}

TEST(CsvTable, TakesTheUnitOfLengthsFromTheOptions) {
  EXPECT_EQ(read("id,wall_thickness\na,2\n", {.length_unit = "um"}), "2:a|2.000000;");
  EXPECT_EQ(read("id,wall_thickness [m]\na,2e-6\n", {.length_unit = "um"}), "2:a|2.000000;");
  EXPECT_EQ(read("id,wall_thickness\na,2\n", {.length_unit_hint = ", or so"}),
            "t.csv:1: column wall_thickness needs its unit, as in 'wall_thickness [m]', or so");
}

TEST(CsvTable, RefusesWhatHasTwoMeanings) {
  EXPECT_EQ(read("id;share\na;1.5\nb;1,5\n"),
            "t.csv:3: share = 1,5: other numbers of the table have a decimal point, this one has not");
  EXPECT_EQ(read("id,wall_thickness [um],WallAvg [um]\n"), "t.csv:1: two columns are called wall_thickness");
  EXPECT_EQ(read("id,wall_thickness,wall_thickness [kg]\n"),
            "2 faults:\n  t.csv:1: column wall_thickness needs its unit, as in 'wall_thickness [m]'\n"
            "  t.csv:1: column wall_thickness [kg]: no such unit");
  EXPECT_EQ(read("id,share\na,1.5.2\n"), "t.csv:2: share = 1.5.2: not a finite number");
  EXPECT_EQ(read("id;share\na;1.234,5\n"), "t.csv:2: share = 1.234,5: not a finite number");
}

TEST(Faults, AreToldInFullUpToTwenty) {
  Faults faults;
  faults.raise();
  faults.add("one");
  EXPECT_THROW(
      try { faults.raise(); } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "one");
        throw;
      },
      InputError);
  for (int i = 2; i <= 25; ++i) faults.add(std::to_string(i));
  Faults outer;
  EXPECT_FALSE(outer.collect([&] { faults.raise(); }));
  EXPECT_EQ(outer.count(), Faults::most_told);
  try {
    faults.raise();
  } catch (const InputErrors& errors) {
    const std::string message = errors.what();
    EXPECT_TRUE(message.starts_with("25 faults:\n  one\n  2\n")) << message;
    EXPECT_TRUE(message.ends_with("\n  20\n  and 5 more")) << message;
  }
}

}  // namespace
}  // namespace rhexis
