// SPDX-License-Identifier: BSD-3-Clause
// The file is read back with HDF5's serial C API, as any other program would. All comparisons are exact: the
// values of the synthetic sources fit single precision.
#include "output/vtkhdf_series.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "output/line_series.hpp"
#include "output/point_series.hpp"
#include "small_disk.hpp"
#include "stored_file.hpp"
#include "synthetic_lines.hpp"
#include "temporary_directory.hpp"

namespace rhexis {
namespace {

using output::SeriesFormat;
using test::expected;
using test::stored;
using test::SyntheticLines;
using test::SyntheticSource;
using test::TemporaryDirectory;

using Numbers = std::vector<double>;

const parallel::Communicator world = parallel::Communicator::world();

output::SeriesPlan plan_in(const std::filesystem::path& directory, std::span<const FieldInfo> fields) {
  return {.directory = directory,
          .title = "test",
          .version = "1.2.3",
          .fields = {fields.begin(), fields.end()},
          .annotations = {"pressure"},
          .steps = {0, 50, 100},
          .formats = {SeriesFormat::vtkhdf}};
}

/// The values of a field at these steps, one after another; 0 for a step that was not written.
Numbers at_steps(const std::string& field, int components, std::int64_t count,
                 const std::vector<long>& steps) {
  Numbers all;
  for (const long step : steps) {
    const Numbers one = expected(field, components, count, step);
    all.insert(all.end(), one.begin(), one.end());
  }
  return all;
}

/// The first rows of a data set.
Numbers first(const std::filesystem::path& path, const std::string& dataset, std::size_t count) {
  Numbers all = stored(path, dataset);
  all.resize(std::min(all.size(), count));
  return all;
}

std::int64_t listed_steps(const std::filesystem::path& path) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t attribute = H5Aopen_by_name(file, "/VTKHDF/Steps", "NSteps", H5P_DEFAULT, H5P_DEFAULT);
  std::int64_t steps = -1;
  H5Aread(attribute, H5T_NATIVE_INT64, &steps);
  H5Aclose(attribute);
  H5Fclose(file);
  return steps;
}

TEST(VtkHdfSeries, HoldsEveryValueOfPointsThatMove) {
  for (const auto precision : {Precision::single_precision, Precision::double_precision}) {
    const TemporaryDirectory directory;
    SyntheticSource source(test::divided(9, 17, world, world.size() == 4 ? 2 : 1), 0);
    output::SeriesPlan plan = plan_in(directory.path(), SyntheticSource::infos);
    plan.precision = precision;
    {
      output::PointSeries series(plan, source.ids(), world);
      series.write_reference(source.positions());
      for (const long step : {0, 50, 73}) {
        source.move_to(step);
        series.write(source);
      }
    }
    if (!world.is_root()) continue;
    const auto file = directory / "particles.vtkhdf";
    const std::size_t n = 9 * 17;
    EXPECT_EQ(listed_steps(file), 3);
    EXPECT_EQ(stored(file, "/VTKHDF/Steps/Values"), (Numbers{0, 0.05, 0.073}));
    EXPECT_EQ(first(file, "/VTKHDF/Points", 9 * n), at_steps("position", 3, n, {0, 50, 73}));
    EXPECT_EQ(first(file, "/VTKHDF/PointData/displacement", 9 * n),
              at_steps("displacement", 3, n, {0, 50, 73}));
    EXPECT_EQ(first(file, "/VTKHDF/PointData/damage", 3 * n), at_steps("damage", 1, n, {0, 50, 73}));
    EXPECT_EQ(stored(file, "/VTKHDF/PointData/reference_position"), expected("position", 3, n, 0));
    EXPECT_EQ(first(file, "/VTKHDF/FieldData/step", 3), (Numbers{0, 50, 73}));
    EXPECT_EQ(first(file, "/VTKHDF/FieldData/pressure", 3), (Numbers{100, 150, 173}));
    const Numbers starts = {0, n, 2 * n, 3 * n};  // of the planned steps and one more
    EXPECT_EQ(stored(file, "/VTKHDF/Steps/PointOffsets"), starts);
    EXPECT_EQ(stored(file, "/VTKHDF/Steps/PointDataOffsets/damage"), starts);
    EXPECT_EQ(stored(file, "/VTKHDF/Steps/PointDataOffsets/reference_position"), Numbers(4, 0));
    EXPECT_EQ(stored(file, "/VTKHDF/Steps/FieldDataOffsets/pressure"), (Numbers{0, 1, 2, 3}));
    EXPECT_EQ(stored(file, "/VTKHDF/Steps/CellOffsets"), Numbers(16, 0));
    EXPECT_EQ(stored(file, "/VTKHDF/Steps/NumberOfParts"), Numbers(4, 1));
    EXPECT_EQ(stored(file, "/VTKHDF/NumberOfPoints"), (Numbers{n}));
    Numbers ids(n + 1);
    for (std::size_t i = 0; i <= n; ++i) ids[i] = static_cast<double>(i);
    EXPECT_EQ(stored(file, "/VTKHDF/Vertices/Offsets"), ids);
    ids.pop_back();
    EXPECT_EQ(stored(file, "/VTKHDF/Vertices/Connectivity"), ids);
    EXPECT_EQ(stored(file, "/VTKHDF/Lines/NumberOfCells"), (Numbers{0}));
    EXPECT_EQ(stored(file, "/VTKHDF/Lines/Offsets"), (Numbers{0}));
    EXPECT_EQ(test::stored_text(file, "/VTKHDF", "Type"), "PolyData");
    EXPECT_EQ(test::stored_text(file, "/VTKHDF/PointData/displacement", "unit"), "m");
    EXPECT_EQ(test::stored_text(file, "/", "title"), "test");
    EXPECT_FALSE(std::filesystem::exists(directory / "particles.h5"));
  }
}

TEST(VtkHdfSeries, HoldsLinesBetweenPointsThatStay) {
  const TemporaryDirectory directory;
  SyntheticLines source(37, world, 0);
  {
    output::LineSeries series(plan_in(directory.path(), SyntheticLines::infos), source, world);
    for (const long step : {0, 50}) {
      source.move_to(step);
      series.write(source);
    }
  }
  if (!world.is_root()) return;
  const auto file = directory / "network.vtkhdf";
  EXPECT_EQ(listed_steps(file), 2);
  EXPECT_EQ(stored(file, "/VTKHDF/Points"), expected("position", 3, 2 * 37, 0));
  EXPECT_EQ(stored(file, "/VTKHDF/Steps/PointOffsets"), Numbers(4, 0));
  EXPECT_EQ(first(file, "/VTKHDF/PointData/velocity", 2 * 37 * 6), at_steps("velocity", 3, 2 * 37, {0, 50}));
  EXPECT_EQ(first(file, "/VTKHDF/CellData/flow", 2 * 37), at_steps("flow", 1, 37, {0, 50}));
  EXPECT_EQ(stored(file, "/VTKHDF/Steps/CellDataOffsets/flow"), (Numbers{0, 37, 74, 111}));
  EXPECT_EQ(first(file, "/VTKHDF/FieldData/vessels", 2), Numbers(2, 34359738366.0));
  const Numbers connectivity = stored(file, "/VTKHDF/Lines/Connectivity"),
                offsets = stored(file, "/VTKHDF/Lines/Offsets");
  ASSERT_EQ(connectivity.size(), 2u * 37u);
  ASSERT_EQ(offsets.size(), 38u);
  for (std::size_t line = 0; line < 37; ++line) {
    EXPECT_EQ(connectivity[2 * line], static_cast<double>(2 * line + line % 2));
    EXPECT_EQ(connectivity[2 * line + 1], static_cast<double>(2 * line + 1 - line % 2));
    EXPECT_EQ(offsets[line + 1], static_cast<double>(2 * line + 2));
  }
}

TEST(VtkHdfSeries, FilesAreTheSameBytesOnAnyNumberOfRanks) {
  const TemporaryDirectory directory, alone;
  const auto write = [](const std::filesystem::path& folder, const parallel::Communicator& ranks) {
    SyntheticSource source(test::divided(9, 17, ranks, 1), 50);
    output::PointSeries points(plan_in(folder, SyntheticSource::infos), source.ids(), ranks);
    points.write_reference(source.positions());
    points.write(source);
    SyntheticLines lines(500, ranks, 50);
    output::LineSeries(plan_in(folder, SyntheticLines::infos), lines, ranks).write(lines);
  };
  write(directory.path(), world);
  if (!world.is_root()) return;
  write(alone.path(), parallel::Communicator(MPI_COMM_SELF));
  for (const char* name : {"particles.vtkhdf", "network.vtkhdf"})
    EXPECT_TRUE(test::text_of(directory / name) == test::text_of(alone / name)) << name;
}

TEST(VtkHdfSeries, BothFormatsStandSideBySide) {
  const TemporaryDirectory directory;
  SyntheticSource source(test::divided(9, 17, world, 1), 0);
  output::SeriesPlan plan = plan_in(directory.path(), SyntheticSource::infos);
  plan.formats = {SeriesFormat::xdmf, SeriesFormat::vtkhdf};
  {
    output::PointSeries series(plan, source.ids(), world);
    series.write_reference(source.positions());
    series.write(source);
  }
  if (!world.is_root()) return;
  EXPECT_EQ(stored(directory / "particles.h5", "/damage/000000"), expected("damage", 1, 9 * 17, 0));
  EXPECT_EQ(first(directory / "particles.vtkhdf", "/VTKHDF/PointData/damage", 9 * 17),
            expected("damage", 1, 9 * 17, 0));
}

TEST(VtkHdfSeries, ACopyTakenMidwayCountsTheStepsSoFar) {
  const TemporaryDirectory directory;
  SyntheticSource source(test::divided(9, 17, world, 1), 0);
  output::PointSeries series(plan_in(directory.path(), SyntheticSource::infos), source.ids(), world);
  const auto copy = directory / "copy.vtkhdf";
  std::int64_t steps = 0;
  for (const long step : {0, 50}) {
    if (world.is_root()) {
      std::filesystem::copy_file(directory / "particles.vtkhdf", copy,
                                 std::filesystem::copy_options::overwrite_existing);
      EXPECT_EQ(listed_steps(copy), steps);
      EXPECT_EQ(stored(copy, "/VTKHDF/Steps/Values").size(), static_cast<std::size_t>(steps));
    }
    world.barrier();
    source.move_to(step);
    series.write(source);
    series.finish();
    ++steps;
  }
}

TEST(VtkHdfSeries, AnEarlyEndIsTheLastStepAndDisplacesAnother) {
  const TemporaryDirectory directory;
  SyntheticSource source(test::divided(9, 17, world, 1), 0);
  output::PointSeries series(plan_in(directory.path(), SyntheticSource::infos), source.ids(), world);
  for (const long step : {0, 61, 73}) {
    source.move_to(step);
    series.write(source);
  }
  if (!world.is_root()) return;
  EXPECT_EQ(stored(directory / "particles.vtkhdf", "/VTKHDF/Steps/Values"), (Numbers{0, 0.073}));
  EXPECT_EQ(first(directory / "particles.vtkhdf", "/VTKHDF/PointData/damage", 2 * 9 * 17),
            at_steps("damage", 1, 9 * 17, {0, 73}));
}

TEST(VtkHdfSeries, AFullDiskIsAnErrorOnAllRanksAndLeavesEarlierSteps) {
  const TemporaryDirectory directory;
  const std::int64_t particles = 50 * 200;
  const test::SmallDisk disk(directory.path(), 2 * particles * 7 * 4 + particles * (12 + 16) + 160000);
  if (!disk.mounted()) GTEST_SKIP() << "mounting a small file system takes the superuser";
  SyntheticSource source(test::divided(50, 200, world, 1), 0);
  output::PointSeries series(plan_in(directory.path(), SyntheticSource::infos), source.ids(), world);
  std::string message;
  for (long step = 0; step <= 100 && message.empty(); step += 50) {
    source.move_to(step);
    message = test::message_of<RunError>([&] { series.write(source); });
  }
  EXPECT_EQ(source.step(), 100);
  EXPECT_EQ(message, (directory / "particles.vtkhdf").string() +
                         ": cannot reserve disk space: No space left on device");
  if (!world.is_root()) return;
  EXPECT_EQ(listed_steps(directory / "particles.vtkhdf"), 2);
  EXPECT_EQ(first(directory / "particles.vtkhdf", "/VTKHDF/Points", 2 * 3 * particles),
            at_steps("position", 3, particles, {0, 50}));
}

TEST(VtkHdfSeries, ADiskTooSmallForTheLayoutIsAnErrorOnAllRanks) {
  const TemporaryDirectory directory;
  for (const std::int64_t kibibytes : {8, 60, 150, 250}) {
    const test::SmallDisk disk(directory.path(), kibibytes * 1024);
    if (!disk.mounted()) GTEST_SKIP() << "mounting a small file system takes the superuser";
    const SyntheticSource source(test::divided(50, 200, world, 1), 0);
    const std::string message = test::message_of<RunError>([&] {
      const output::PointSeries series(plan_in(directory.path(), SyntheticSource::infos), source.ids(),
                                       world);
    });
    EXPECT_EQ(message, (directory / "particles.vtkhdf").string() +
                           ": cannot reserve disk space: No space left on device");
  }
}

}  // namespace
}  // namespace rhexis
