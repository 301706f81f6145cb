// SPDX-License-Identifier: BSD-3-Clause
// All comparisons are exact: the values of the synthetic lines fit single precision.
#include "output/line_series.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "small_disk.hpp"
#include "stored_file.hpp"
#include "synthetic_lines.hpp"
#include "temporary_directory.hpp"

namespace rhexis {
namespace {

using output::LineSeries;
using output::LineSeriesPlan;
using test::expected;
using test::stored;
using test::stored_text;
using test::SyntheticLines;
using test::TemporaryDirectory;

const parallel::Communicator world = parallel::Communicator::world();

LineSeriesPlan plan_in(const std::filesystem::path& directory, std::vector<long> steps) {
  return {.directory = directory,
          .title = "test",
          .version = "1.2.3",
          .fields = {SyntheticLines::infos.begin(), SyntheticLines::infos.end()},
          .steps = std::move(steps)};
}

void expect_step(const std::filesystem::path& path, std::int64_t lines, long step, const std::string& place) {
  EXPECT_EQ(stored(path, "/pressure/" + place), expected("pressure", 1, 2 * lines, step));
  EXPECT_EQ(stored(path, "/velocity/" + place), expected("velocity", 3, 2 * lines, step));
  EXPECT_EQ(stored(path, "/flow/" + place), expected("flow", 1, lines, step));
  EXPECT_EQ(stored(path, "/direction/" + place), expected("direction", 3, lines, step));
}

TEST(LineSeries, HoldsEveryValueAndGlobalLinesThoughARankHasNone) {
  for (const auto precision : {Precision::single_precision, Precision::double_precision}) {
    const TemporaryDirectory directory;
    SyntheticLines source(37, world, 0);
    LineSeriesPlan plan = plan_in(directory.path(), {0, 50});
    plan.precision = precision;
    {
      LineSeries series(plan, source, world);
      series.write(source);
      source.move_to(50);
      series.write(source);
    }
    if (!world.is_root()) continue;
    const auto file = directory / "network.h5";
    expect_step(file, 37, 0, "000000");
    expect_step(file, 37, 50, "000050");
    EXPECT_EQ(stored(file, "/position"), expected("position", 3, 2 * 37, 0));
    const std::vector<double> connectivity = stored(file, "/connectivity");
    ASSERT_EQ(connectivity.size(), 2u * 37u);
    for (std::size_t line = 0; line < 37; ++line) {
      EXPECT_EQ(connectivity[2 * line], static_cast<double>(2 * line + line % 2));
      EXPECT_EQ(connectivity[2 * line + 1], static_cast<double>(2 * line + 1 - line % 2));
    }
    EXPECT_EQ(stored_text(file, "/pressure", "unit"), "Pa");
    EXPECT_EQ(stored_text(file, "/flow", "unit"), "m3/s");
    EXPECT_EQ(stored_text(file, "/position", "unit"), "m");
    EXPECT_EQ(stored_text(file, "/", "version"), "1.2.3");
    EXPECT_EQ(stored_text(file, "/", "title"), "test");
  }
}

TEST(LineSeries, FilesAreTheSameBytesOnAnyNumberOfRanks) {
  const TemporaryDirectory directory, alone;
  const parallel::Communicator self(MPI_COMM_SELF);
  const auto write = [](const std::filesystem::path& folder, const parallel::Communicator& communicator) {
    SyntheticLines source(500, communicator, 0);
    LineSeries series(plan_in(folder, {0, 50}), source, communicator);
    for (const long step : {0, 50}) {
      source.move_to(step);
      series.write(source);
    }
  };
  write(directory.path(), world);
  if (!world.is_root()) return;
  write(alone.path(), self);
  for (const char* name : {"network.h5", "network.xdmf"})
    EXPECT_EQ(test::text_of(directory / name) == test::text_of(alone / name), true) << name;
}

TEST(LineSeries, AnEarlyEndHasAPlaceOfItsOwn) {
  const TemporaryDirectory directory;
  SyntheticLines source(37, world, 0);
  LineSeries series(plan_in(directory.path(), {0, 50, 100}), source, world);
  for (const long step : {0, 61, 73}) {
    source.move_to(step);
    series.write(source);
  }
  if (!world.is_root()) return;
  expect_step(directory / "network.h5", 37, 0, "000000");
  expect_step(directory / "network.h5", 37, 73, "unplanned");
  const std::string listed = test::text_of(directory / "network.xdmf");
  EXPECT_NE(listed.find("<Time Value=\"0.073\"/>"), std::string::npos);
  EXPECT_EQ(listed.find("<Time Value=\"0.061\"/>"), std::string::npos);
}

TEST(LineSeries, AFullDiskIsAnErrorOnAllRanksAndLeavesEarlierSteps) {
  const TemporaryDirectory directory;
  const std::int64_t lines = 10000, bytes_of_step = lines * (2 * 4 + 4) * 4;
  const std::int64_t fixed = lines * (2 * 3 * 4 + 2 * 8);
  const test::SmallDisk disk(directory.path(), fixed + 2 * bytes_of_step + 200000);
  if (!disk.mounted()) GTEST_SKIP() << "mounting a small file system takes the superuser";
  SyntheticLines source(lines, world, 0);
  LineSeries series(plan_in(directory.path(), {0, 50, 100}), source, world);
  std::string message;
  for (long step = 0; step <= 100 && message.empty(); step += 50) {
    source.move_to(step);
    message = test::message_of<RunError>([&] { series.write(source); });
  }
  EXPECT_EQ(source.step(), 100);
  EXPECT_EQ(message,
            (directory / "network.h5").string() + ": cannot reserve disk space: No space left on device");
  if (!world.is_root()) return;
  expect_step(directory / "network.h5", lines, 0, "000000");
  expect_step(directory / "network.h5", lines, 50, "000050");
  EXPECT_EQ(test::text_of(directory / "network.xdmf").find("000100"), std::string::npos);
}

TEST(LineSeries, WhatCannotBeStoredIsAnErrorOnAllRanks) {
  const TemporaryDirectory directory;
  const auto message_of = [&](SyntheticLines source, const std::filesystem::path& folder) {
    return test::message_of<RunError>([&] { const LineSeries series(plan_in(folder, {0}), source, world); });
  };
  EXPECT_EQ(message_of(SyntheticLines(0, world, 0), directory.path()), "there are no lines to store");
  SyntheticLines broken(37, world, 0);
  broken.break_connectivity();
  EXPECT_NE(message_of(broken, directory.path()).find("a line ends at point"), std::string::npos);
  EXPECT_NE(message_of(SyntheticLines(37, world, 0), directory / "missing").find("cannot create the file"),
            std::string::npos);
}

}  // namespace
}  // namespace rhexis
