// SPDX-License-Identifier: BSD-3-Clause
#include "output/history.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "temporary_directory.hpp"

namespace rhexis {
namespace {

using output::History;
using output::HistoryRow;

const parallel::Communicator world = parallel::Communicator::world();
const std::string header =
    "step,time_s,pressure_Pa,max_displacement_m,max_damage,broken_bonds,kinetic_J,strain_J,external_work_J,"
    "rupture_length_m,leak_m3_s,fracture_J,opening_m2\n";

HistoryRow row_of(long step) {
  return {.step = step, .time_s = 0.1 * static_cast<double>(step), .broken_bonds = 7};
}

TEST(History, HasOneRowPerOutputWithNumbersThatReadBack) {
  const test::TemporaryDirectory directory;
  History history(directory / "history.csv", world);
  history.append({1, 0.1, 238e3, 1.0 / 3, 0.25, 12, 1e-9, 2e-300, -0.0, 4e-4, 5.5e-12, 3e-7, 2e-8});
  history.append({.step = 2});
  // Read while it is open: a row is on disk once append returns.
  EXPECT_EQ(test::text_of(directory / "history.csv"),
            header +
                "1,0.1,238000,0.3333333333333333,0.25,12,1e-09,2e-300,-0,0.0004,5.5e-12,3e-07,2e-08\n2,0,0,0,"
                "0,0,0,0,0,0,,0,0\n");
}

TEST(History, ContinuesAfterARestartWithoutTheRowsBeyondIt) {
  const test::TemporaryDirectory directory;
  const auto path = directory / "history.csv";
  {
    History history(path, world);
    for (const long step : {0, 10, 20, 30}) history.append(row_of(step));
  }
  if (world.is_root()) std::ofstream(path, std::ios::app) << "15,0.0";  // cut short by a crash
  world.barrier();
  History history(path, world, 10);
  history.append(row_of(25));
  EXPECT_EQ(test::text_of(path),
            header + "0,0,0,0,0,7,0,0,0,0,,0,0\n10,1,0,0,0,7,0,0,0,0,,0,0\n25,2.5,0,0,0,7,0,0,0,0,,0,0\n");
}

TEST(History, AFileThatIsTakenAwayOrReplacedIsMissed) {
  const test::TemporaryDirectory directory;
  const auto path = directory / "history.csv";
  History history(path, world);
  history.append(row_of(1));
  if (world.is_root()) std::filesystem::rename(path, directory / "other.csv");
  world.barrier();
  std::string message = test::message_of<RunError>([&] { history.append(row_of(2)); });
  EXPECT_NE(message.find("history.csv: has been taken away"), std::string::npos) << message;
  if (world.is_root()) std::ofstream(path) << "another";
  world.barrier();
  message = test::message_of<RunError>([&] { history.append(row_of(2)); });
  EXPECT_NE(message.find("history.csv: has been replaced"), std::string::npos) << message;
  EXPECT_EQ(test::text_of(path), "another");
}

TEST(History, ARestartWithoutAFileStartsOne) {
  const test::TemporaryDirectory directory;
  History history(directory / "history.csv", world, 10);
  EXPECT_EQ(test::text_of(directory / "history.csv"), header);
}

TEST(History, DoesNotTouchAFileThatIsNotAHistory) {
  const test::TemporaryDirectory directory;
  const auto path = directory / "history.csv";
  const std::string row = "0,0,0,0,0,7,0,0,0,0,,0,0\n";
  for (const std::string& text :
       {std::string("step,time\n1,2\n"), header + "one,2\n", header + row + row,
        header + "0,0,0,0,0,7,0,nan,0,0,,0,0\n", header + "0,0,0,0,0,7,0,0,0,0,,0\n"}) {
    if (world.is_root()) std::ofstream(path) << text;
    world.barrier();
    const std::string message = test::message_of<InputError>([&] { History(path, world, 10); });
    EXPECT_EQ(message.find(path.string() + ':'), 0u) << message;
    EXPECT_EQ(test::text_of(path), text);
    world.barrier();
  }
}

TEST(History, AFileThatCannotBeReadIsNotReplaced) {
  const test::TemporaryDirectory directory;
  const auto path = directory / "history.csv";
  if (world.is_root()) std::filesystem::create_directory(path);  // root may read any file, but no folder
  world.barrier();
  const std::string message = test::message_of<InputError>([&] { History(path, world, 10); });
  EXPECT_NE(message.find("history.csv: cannot be read: "), std::string::npos) << message;
}

TEST(History, AFolderThatIsNotThereIsARunErrorOnAllRanks) {
  const test::TemporaryDirectory directory;
  const std::string message =
      test::message_of<RunError>([&] { History(directory / "no/history.csv", world); });
  EXPECT_NE(message.find("no/history.csv: cannot create the file: No such file"), std::string::npos)
      << message;
}

}  // namespace
}  // namespace rhexis
