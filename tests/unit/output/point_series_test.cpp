// SPDX-License-Identifier: BSD-3-Clause
// The file is read back with HDF5's serial C API, as any other program would. All comparisons are exact: the
// values of the synthetic source fit single precision.
#include "output/point_series.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "output/disk_space.hpp"
#include "small_disk.hpp"
#include "stored_file.hpp"
#include "synthetic_source.hpp"
#include "temporary_directory.hpp"

namespace rhexis {
namespace {

using output::PointSeries;
using output::PointSeriesPlan;
using parallel::Communicator;
using test::bytes_on_disk;
using test::expected;
using test::stored;
using test::stored_text;
using test::SyntheticSource;
using test::TemporaryDirectory;

const Communicator world = Communicator::world();

PointSeriesPlan plan_in(const std::filesystem::path& directory, std::vector<long> steps) {
  return {.directory = directory,
          .title = "test",
          .version = "1.2.3",
          .fields = {SyntheticSource::infos.begin(), SyntheticSource::infos.end()},
          .steps = std::move(steps)};
}

void expect_step(const std::filesystem::path& path, std::int64_t points, long step,
                 const std::string& place) {
  EXPECT_EQ(stored(path, "/position/" + place), expected("position", 3, points, step));
  EXPECT_EQ(stored(path, "/displacement/" + place), expected("displacement", 3, points, step));
  EXPECT_EQ(stored(path, "/damage/" + place), expected("damage", 1, points, step));
}

std::vector<int> column_divisions() {
  return world.size() == 4 ? std::vector{1, 2, 4} : std::vector{1, world.size()};
}

TEST(PointSeries, HoldsEveryValueHoweverTheBodyIsDivided) {
  for (const auto precision : {Precision::single_precision, Precision::double_precision}) {
    for (const int parts : column_divisions()) {
      const TemporaryDirectory directory;
      SyntheticSource source(test::divided(9, 17, world, parts), 0);
      PointSeriesPlan plan = plan_in(directory.path(), {0, 50});
      plan.precision = precision;
      {
        PointSeries series(plan, source.ids(), world);
        series.write_reference(source.positions());
        series.write(source);
        source.move_to(50);
        series.write(source);
      }
      if (!world.is_root()) continue;
      const auto file = directory / "particles.h5";
      expect_step(file, 9 * 17, 0, "000000");
      expect_step(file, 9 * 17, 50, "000050");
      EXPECT_EQ(stored(file, "/reference_position"), expected("position", 3, 9 * 17, 0));
      const std::vector<double> connectivity = stored(file, "/connectivity");
      ASSERT_EQ(connectivity.size(), 9u * 17u);
      for (std::size_t i = 0; i < connectivity.size(); ++i)
        EXPECT_EQ(connectivity[i], static_cast<double>(i));
      EXPECT_EQ(stored_text(file, "/displacement", "unit"), "m");
      EXPECT_EQ(stored_text(file, "/damage", "unit"), "1");
      EXPECT_EQ(stored_text(file, "/", "version"), "1.2.3");
      EXPECT_EQ(stored_text(file, "/", "title"), "test");
    }
  }
}

TEST(PointSeries, HoldsParticlesOfRangesOfAnyLength) {
  const TemporaryDirectory directory;
  SyntheticSource source(test::dealt_out(150, world), 50);
  {
    PointSeries series(plan_in(directory.path(), {50}), source.ids(), world);
    series.write_reference(source.positions());
    series.write(source);
  }
  if (world.is_root()) expect_step(directory / "particles.h5", 150, 50, "000050");
}

TEST(PointSeries, FilesAreTheSameBytesOnAnyNumberOfRanks) {
  const TemporaryDirectory directory, alone;
  const auto write = [](const std::filesystem::path& where, const Communicator& ranks, int parts) {
    SyntheticSource source(test::divided(9, 17, ranks, parts), 50);
    PointSeries series(plan_in(where, {50}), source.ids(), ranks);
    series.write_reference(source.positions());
    series.write(source);
  };
  if (world.is_root()) write(alone.path(), Communicator(MPI_COMM_SELF), 1);
  for (const int parts : column_divisions()) {
    write(directory.path(), world, parts);
    if (!world.is_root()) continue;
    EXPECT_EQ(test::text_of(directory / "particles.xdmf"), test::text_of(alone / "particles.xdmf"));
    EXPECT_TRUE(test::text_of(directory / "particles.h5") == test::text_of(alone / "particles.h5"));
  }
}

TEST(PointSeries, ACopyTakenMidwayHoldsTheStepsSoFar) {
  const TemporaryDirectory directory;
  SyntheticSource source(test::divided(9, 17, world, 1), 0);
  const auto listed = [&](const std::string& place) {
    return test::text_of(directory / "particles.xdmf").find("/damage/" + place) != std::string::npos;
  };
  {
    PointSeries series(plan_in(directory.path(), {0, 50, 100}), source.ids(), world);
    for (const long step : {0, 50}) {
      source.move_to(step);
      series.write(source);
      if (!world.is_root()) continue;
      // What a crash at this moment leaves: the writer has closed nothing.
      const auto copy = directory / "copy.h5";
      std::filesystem::copy_file(directory / "particles.h5", copy,
                                 std::filesystem::copy_options::overwrite_existing);
      expect_step(copy, 9 * 17, 0, "000000");
      if (step == 0) continue;  // listed as soon as it is on the disk
      expect_step(copy, 9 * 17, 50, "000050");
      EXPECT_TRUE(listed("000000"));
      EXPECT_FALSE(listed("000100"));
    }
  }
  if (!world.is_root()) return;
  EXPECT_TRUE(listed("000050"));
  EXPECT_FALSE(listed("000100"));
}

TEST(PointSeries, StepsNotYetWrittenTakeNoDiskSpace) {
  const TemporaryDirectory directory;
  SyntheticSource source(test::divided(50, 200, world, 1), 0);
  const std::int64_t bytes_of_step = 50 * 200 * 7 * 4;
  std::vector<long> steps(100);
  for (std::size_t i = 0; i < steps.size(); ++i) steps[i] = static_cast<long>(10 * i);
  PointSeries series(plan_in(directory.path(), steps), source.ids(), world);
  series.write(source);
  if (!world.is_root()) return;
  EXPECT_GT(static_cast<std::int64_t>(std::filesystem::file_size(directory / "particles.h5")),
            100 * bytes_of_step);
  EXPECT_LT(bytes_on_disk(directory / "particles.h5"), 3 * bytes_of_step);
}

TEST(PointSeries, AnEarlyEndHasAPlaceOfItsOwn) {
  const TemporaryDirectory directory;
  SyntheticSource source(test::divided(9, 17, world, 1), 0);
  PointSeries series(plan_in(directory.path(), {0, 50, 100}), source.ids(), world);
  for (const long step : {0, 50, 61, 73}) {
    source.move_to(step);
    series.write(source);
  }
  if (!world.is_root()) return;
  expect_step(directory / "particles.h5", 9 * 17, 50, "000050");
  expect_step(directory / "particles.h5", 9 * 17, 73, "unplanned");
  const std::string listed = test::text_of(directory / "particles.xdmf");
  EXPECT_NE(listed.find("<Time Value=\"0.073\"/>"), std::string::npos);
  EXPECT_EQ(listed.find("<Time Value=\"0.061\"/>"), std::string::npos);
}

TEST(PointSeries, AFullDiskIsAnErrorOnAllRanksAndLeavesEarlierSteps) {
  const TemporaryDirectory directory;
  const std::int64_t bytes_of_step = 50 * 200 * 7 * 4;
  const test::SmallDisk disk(directory.path(), 4 * bytes_of_step + 160000);
  if (!disk.mounted()) GTEST_SKIP() << "mounting a small file system takes the superuser";
  SyntheticSource source(test::divided(50, 200, world, 1), 0);
  PointSeries series(plan_in(directory.path(), {0, 50, 100, 150}), source.ids(), world);
  series.write(source);
  std::string message;
  for (long step = 50; step <= 150 && message.empty(); step += 50) {
    source.move_to(step);
    message = test::message_of<RunError>([&] { series.write(source); });
  }
  EXPECT_EQ(source.step(), 150);
  EXPECT_EQ(message,
            (directory / "particles.h5").string() + ": cannot reserve disk space: No space left on device");
  if (!world.is_root()) return;
  for (const long step : {0, 50, 100}) {
    expect_step(directory / "particles.h5", 50 * 200, step,
                step == 0    ? "000000"
                : step == 50 ? "000050"
                             : "000100");
  }
  EXPECT_EQ(test::text_of(directory / "particles.xdmf").find("000150"), std::string::npos);
  // The space of the step that failed is free again for what is left to say.
  std::ofstream last_words(directory / "run.json");
  last_words << std::string(100000, ' ') << std::flush;
  EXPECT_TRUE(last_words.good());
}

TEST(PointSeries, ADiskTooSmallForTheLayoutIsAnErrorOnAllRanks) {
  const TemporaryDirectory directory;
  for (const std::int64_t kibibytes : {8, 60, 150, 200}) {
    const test::SmallDisk disk(directory.path(), kibibytes * 1024);
    if (!disk.mounted()) GTEST_SKIP() << "mounting a small file system takes the superuser";
    const SyntheticSource source(test::divided(50, 200, world, 1), 0);
    const std::string message = test::message_of<RunError>(
        [&] { const PointSeries series(plan_in(directory.path(), {0}), source.ids(), world); });
    EXPECT_EQ(message,
              (directory / "particles.h5").string() + ": cannot reserve disk space: No space left on device");
  }
}

TEST(PointSeries, AFolderThatIsNotThereIsAnErrorOnAllRanks) {
  const TemporaryDirectory directory;
  const SyntheticSource source(test::divided(9, 17, world, 1), 0);
  const std::string message = test::message_of<RunError>(
      [&] { const PointSeries series(plan_in(directory / "missing", {0}), source.ids(), world); });
  EXPECT_NE(message.find("missing/particles.h5: cannot create the file: No such file"), std::string::npos)
      << message;
}

TEST(DiskSpace, WhatCannotBeReservedAsAWholeIsGivenBack) {
  const TemporaryDirectory directory;
  if (!world.is_root()) return;
  const auto path = directory / "file";
  std::ofstream(path) << "text";
  const std::vector<output::ByteRange> possible = {{1 << 16, 1 << 20}};
  const std::vector<output::ByteRange> too_much = {{1 << 16, 1 << 20}, {1 << 21, std::int64_t{1} << 61}};
  const std::string message = test::message_of<RunError>([&] { output::reserve_space(path, too_much); });
  EXPECT_NE(message.find(path.string() + ": cannot reserve disk space"), std::string::npos) << message;
  EXPECT_LT(bytes_on_disk(path), 1 << 20);
  output::reserve_space(path, possible);
  EXPECT_EQ(test::text_of(path).substr(0, 4), "text");
}

}  // namespace
}  // namespace rhexis
