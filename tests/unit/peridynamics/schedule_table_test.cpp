// SPDX-License-Identifier: BSD-3-Clause
// Schedules by table: from files, repeated, against closed forms.
#include "peridynamics/loads/schedule_table.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "peridynamics/loads/schedule.hpp"
#include "support/vessels.hpp"

namespace rhexis::peridynamics {
namespace {

/// Converts the units that the tests write.
double to_si(std::string_view text, std::string_view) {
  if (text == "1 ms") return 1e-3;
  if (text == "1 kPa") return 1e3;
  if (text == "1 s" || text == "1 Pa") return 1;
  throw InputError("no such unit");
}

std::string error_of(const std::string& text) {
  try {
    schedule_table("beat.csv", text, to_si);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// A triangle of period 4 s that rises from 10 Pa to 30 Pa in 1 s.
Parameters triangle() {
  Parameters p = test::paper_vessel();
  p.schedule = Schedule::table;
  p.table = {{0, 10}, {1, 30}, {4, 10}};
  return p;
}

TEST(ScheduleTable, IsReadInItsUnits) {
  const std::vector<CurvePoint> expected{{0, 10}, {1e-3, 2e3}, {1.5, 0}};
  EXPECT_EQ(schedule_table("a", "time [s],pressure [Pa]\n0,10\n0.001,2e3\n1.5,0\n", to_si), expected);
  EXPECT_EQ(
      schedule_table("a", "\xef\xbb\xbf pressure [kPa] , time [ms]\r\n# rest\r\n0.01,0\r\n\r\n2,1\r\n0,1500",
                     to_si),
      expected);
  EXPECT_EQ(schedule_table("a", "Time (s);PRESSURE (Pa)\r0;10\r0,001;2e3\r1,5;0\r", to_si), expected);
}

TEST(ScheduleTable, SaysWhatIsWrongWhere) {
  const std::string head = "time [s],pressure [kPa]\n";
  struct Case {
    std::string text;
    std::vector<const char*> fragments;
  };
  for (const Case& c : std::vector<Case>{
           {"time [s];pressure [kPa]\n0;1\n1.5;2\n2,5;2\n", {"beat.csv:4", "time = 2,5", "decimal point"}},
           {head + "0,1\n0,5,2,5\n", {"beat.csv:3", "4 fields", "need a point"}},
           {head + "\"0,5\",1\n", {"beat.csv:2", "time = 0,5", "not a finite number", "point"}},
           {head + "0,1\n1,high\n", {"beat.csv:3", "pressure = high", "not a finite number"}},
           {head + "0,1\n1,nan\n", {"beat.csv:3", "pressure = nan"}},
           {head + "0,1\n1,\n", {"beat.csv:3", "pressure is missing"}},
           {head + "0,1\n1,-2\n", {"beat.csv:3", "pressure = -2", "at least 0"}},
           {head + "0,1\n2,1\n2,1\n", {"beat.csv:4", "time = 2", "must increase", "2 s"}},
           {head + "0,1\n", {"beat.csv", "at least two rows"}},
           {"time [s],pressure\n0,1\n1,1\n", {"beat.csv:1", "column pressure needs its unit"}},
           {"time [s]\n0\n", {"beat.csv:1", "no column pressure"}},
           {"time [s],pressure [furlong]\n0,1\n", {"beat.csv:1", "pressure [furlong]", "no such unit"}},
           {"time [s],flow [Pa]\n0,1\n", {"beat.csv:1", "no column 'flow'", "time, pressure"}},
           {"", {"beat.csv", "no header"}},
           {std::string("ti\0me", 5), {"beat.csv", "not a text file"}}}) {
    for (const char* fragment : c.fragments)
      EXPECT_NE(error_of(c.text).find(fragment), std::string::npos)
          << fragment << " in: " << error_of(c.text);
  }
}

TEST(ScheduleTable, ChecksumIsFnv1a) {
  // http://www.isthe.com/chongo/tech/comp/fnv: of "" and "foobar".
  EXPECT_EQ(checksum(""), "fnv1a:cbf29ce484222325");
  EXPECT_EQ(checksum("foobar"), "fnv1a:85944171f73967e8");
}

TEST(RepeatedTable, IsAFunctionOfTheTimeWithinAPeriod) {
  Parameters p = triangle();
  p.repeat = true;
  resolve(p);
  const auto exact = [](double t) { return t < 1 ? 10 + 20 * t : 30 - 20 * (t - 1) / 3; };
  for (int beat : {0, 1, 2, 1000}) {
    for (double t : {0.0, 0.25, 0.999, 1.0, 1.75, 3.5}) {
      EXPECT_NEAR(scheduled_pressure(p, 4 * beat + t), exact(t), 1e-9) << beat << ' ' << t;
    }
    EXPECT_NEAR(scheduled_pressure(p, 4 * beat + std::nextafter(4.0, 0.0)), 10, 1e-9) << "no leap at the end";
  }
  EXPECT_DOUBLE_EQ(highest_pressure(p), 30);
  p.repeat = false;
  EXPECT_DOUBLE_EQ(scheduled_pressure(p, 5), 10) << "constant outside";
}

TEST(RepeatedTable, StartsAtRestUnderAPressureWithinThePeriod) {
  Parameters p = triangle();
  p.repeat = true;
  p.equilibrium_pressure = 20;
  resolve(p);
  EXPECT_DOUBLE_EQ(p.schedule_start, 0.5);
  EXPECT_NEAR(scheduled_pressure(p, 0), 20, 1e-12);
  EXPECT_NEAR(scheduled_pressure(p, 4), 20, 1e-12);
}

TEST(RepeatedTable, NeedsAPeriod) {
  const auto error = [](const std::vector<CurvePoint>& table) -> std::string {
    Parameters p = triangle();
    p.repeat = true;
    p.table = table;
    try {
      resolve(p);
    } catch (const InputError& e) {
      return e.key + ": " + e.what();
    }
    return "accepted";
  };
  EXPECT_EQ(error({{0, 10}, {1, 30}, {4, 10 + 1e-6}}), "accepted");
  EXPECT_EQ(error({{0, 0}, {1, 0}}), "accepted");
  EXPECT_EQ(error({{0, 10}, {1, 30}, {4, 12}})
                .rfind("load.repeat: a table that is repeated ends at the pressure", 0),
            0u);
  EXPECT_EQ(error({{1, 10}, {4, 10}}).rfind("load.repeat: a table that is repeated begins at 0 s", 0), 0u);
}

TEST(LongTable, IsSearchedNotRead) {
  Parameters p = triangle();
  p.table.clear();
  constexpr int points = 1'000'000;
  for (int i = 0; i < points; ++i) p.table.emplace_back(i, i);
  resolve(p);
  // As many look-ups as points: a search of each through the table would not end.
  for (int i = 0; i < points; ++i)
    ASSERT_DOUBLE_EQ(scheduled_pressure(p, i + 0.5), std::min(i + 0.5, points - 1.0));
}

}  // namespace
}  // namespace rhexis::peridynamics
