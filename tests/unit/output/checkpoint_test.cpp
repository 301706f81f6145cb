// Restart from a checkpoint on other numbers of ranks; all comparisons are exact.
#include "output/checkpoint.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/error.hpp"
#include "small_disk.hpp"
#include "synthetic_source.hpp"
#include "temporary_directory.hpp"

namespace rhexis {
namespace {

using output::CheckpointReader;
using output::CheckpointWriter;
using output::WordBlock;
using parallel::Communicator;
using test::TemporaryDirectory;

const Communicator world = Communicator::world();
constexpr std::int64_t columns = 9, rows = 32, table_rows = 21, table_words = 4;
constexpr double odd_number = 0.1 + 1e-17;

/// The first `count` ranks, or fewer; runs `action` on them with a communicator of their own.
template <class Action>
void on_ranks(int count, Action&& action) {
  MPI_Comm some = MPI_COMM_NULL;
  MPI_Comm_split(world.handle(), world.rank() < count ? 0 : MPI_UNDEFINED, world.rank(), &some);
  if (some != MPI_COMM_NULL) {
    action(Communicator(some));
    MPI_Comm_free(&some);
  }
  world.barrier();
}

/// Divides the table among ranks along its rows and words, as a body among blocks.
WordBlock divided_table(const Communicator& ranks, int parts) {
  const PointLayout like = test::divided(table_rows, table_words, ranks, parts);
  return {.rows = table_rows,
          .words = table_words,
          .first_row = like.first_column,
          .row_count = like.column_count,
          .first_word = like.first_row,
          .word_count = like.row_count};
}

std::vector<double> numbers(const PointLayout& layout) {
  std::vector<double> values;
  for (std::int64_t c = 0; c < layout.column_count; ++c) {
    for (std::int64_t r = 0; r < layout.row_count; ++r) {
      values.push_back(1.0 /
                       static_cast<double>(1 + (layout.first_column + c) * rows + layout.first_row + r));
    }
  }
  return values;
}

std::vector<std::uint16_t> words(const WordBlock& block) {
  std::vector<std::uint16_t> values;
  for (std::int64_t r = 0; r < block.row_count; ++r) {
    for (std::int64_t w = 0; w < block.word_count; ++w) {
      values.push_back(
          static_cast<std::uint16_t>(60000 + (block.first_row + r) * table_words + block.first_word + w));
    }
  }
  return values;
}

void write_checkpoint(const std::filesystem::path& path, const Communicator& ranks, int parts) {
  const PointLayout layout = test::divided(columns, rows, ranks, parts);
  const WordBlock block = divided_table(ranks, parts);
  CheckpointWriter writer(path, ranks);
  writer.write("velocity_x", layout, numbers(layout));
  writer.write("bonds", block, words(block));
  writer.write("step", std::numeric_limits<std::int64_t>::max());
  writer.write("time_s", odd_number);
  writer.write("input", std::string("vessel = \"å\"\n"));
  writer.write("nothing", std::string());
  writer.close();
}

void expect_checkpoint(const std::filesystem::path& path, const Communicator& ranks, int parts) {
  const PointLayout layout = test::divided(columns, rows, ranks, parts);
  const WordBlock block = divided_table(ranks, parts);
  CheckpointReader reader(path, ranks);
  std::vector<double> velocity(static_cast<std::size_t>(layout.local_count()));
  reader.read("velocity_x", layout, velocity);
  EXPECT_EQ(velocity, numbers(layout));
  std::vector<std::uint16_t> bonds(static_cast<std::size_t>(block.local_count()));
  reader.read("bonds", block, bonds);
  EXPECT_EQ(bonds, words(block));
  std::int64_t step = 0;
  double time_s = 0;
  std::string input, nothing = "something";
  reader.read("step", step);
  reader.read("time_s", time_s);
  reader.read("input", input);
  reader.read("nothing", nothing);
  EXPECT_EQ(step, std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(time_s, odd_number);
  EXPECT_EQ(input, "vessel = \"å\"\n");
  EXPECT_EQ(nothing, "");
}

TEST(Checkpoint, IsReadOnOtherNumbersOfRanks) {
  const TemporaryDirectory directory;
  const auto path = directory / "state.h5";
  for (const int writers : {1, 2, 4}) {
    on_ranks(writers,
             [&](const Communicator& ranks) { write_checkpoint(path, ranks, ranks.size() == 4 ? 2 : 1); });
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(directory.path()), {}), 1);
    for (const int readers : {1, 2, 4}) {
      on_ranks(readers, [&](const Communicator& ranks) { expect_checkpoint(path, ranks, ranks.size()); });
    }
  }
}

TEST(Checkpoint, AnUnfinishedOneLeavesTheEarlierOneAndNothingElse) {
  const TemporaryDirectory directory;
  write_checkpoint(directory / "state.h5", world, 1);
  {
    CheckpointWriter writer(directory / "state.h5", world);
    writer.write("step", std::int64_t{1});
  }
  world.barrier();
  expect_checkpoint(directory / "state.h5", world, 1);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(directory.path()), {}), 1);
}

TEST(Checkpoint, AFullDiskIsAnErrorOnAllRanksAndLeavesNothing) {
  const TemporaryDirectory directory;
  const test::SmallDisk disk(directory.path(), 400 * 1024);
  if (!disk.mounted()) GTEST_SKIP() << "mounting a small file system takes the superuser";
  const PointLayout layout = test::divided(200, 100, world, 1);
  const std::vector<double> values(static_cast<std::size_t>(layout.local_count()));
  const std::string message = test::message_of<RunError>([&] {
    CheckpointWriter writer(directory / "state.h5", world);
    for (const char* name : {"x", "y", "z"}) writer.write(name, layout, values);
  });
  EXPECT_EQ(message.find((directory / ".state.h5.").string()), 0) << message;
  EXPECT_NE(message.find(": cannot reserve disk space: No space left on device"), std::string::npos)
      << message;
  world.barrier();
  EXPECT_TRUE(std::filesystem::is_empty(directory.path()));
}

TEST(Checkpoint, WritingWhereThereIsNoFolderIsARunError) {
  const TemporaryDirectory directory;
  const std::string message =
      test::message_of<RunError>([&] { CheckpointWriter(directory / "no/state.h5", world); });
  EXPECT_NE(message.find("no/state.h5: cannot create the file: No such file"), std::string::npos) << message;
}

TEST(Checkpoint, AFileThatIsNoCheckpointIsAnInputError) {
  const TemporaryDirectory directory;
  if (world.is_root()) std::ofstream(directory / "text.h5") << "not HDF5";
  world.barrier();
  const auto message = [&](const std::string& name) {
    return test::message_of<InputError>([&] { CheckpointReader(directory / name, world); });
  };
  EXPECT_NE(message("absent.h5").find("absent.h5: cannot open: there is no such file"), std::string::npos);
  EXPECT_NE(message("").find("it is not a file"), std::string::npos);
  EXPECT_NE(message("text.h5").find("text.h5: cannot open the file"), std::string::npos)
      << message("text.h5");

  write_checkpoint(directory / "cut.h5", world, 1);
  if (world.is_root()) std::filesystem::resize_file(directory / "cut.h5", 3000);
  world.barrier();
  EXPECT_NE(message("cut.h5").find("cut.h5: cannot open the file: truncated file"), std::string::npos)
      << message("cut.h5");
}

TEST(Checkpoint, WhatDiffersIsNamed) {
  const TemporaryDirectory directory;
  const auto path = directory / "state.h5";
  write_checkpoint(path, world, 1);
  CheckpointReader reader(path, world);
  const PointLayout longer = test::divided(columns, rows + 1, world, 1);
  std::vector<double> values(static_cast<std::size_t>(longer.local_count()));
  std::int64_t number = 0;
  const std::string shape = test::message_of<InputError>([&] { reader.read("velocity_x", longer, values); });
  EXPECT_EQ(shape, path.string() + ": 'velocity_x' holds 288 values, but this run has 297");
  const std::string missing =
      test::message_of<InputError>([&] { reader.read("velocity_y", longer, values); });
  EXPECT_NE(missing.find(path.string() + ": cannot open data set velocity_y"), std::string::npos) << missing;
  const std::string attribute = test::message_of<InputError>([&] { reader.read("steps", number); });
  EXPECT_NE(attribute.find(path.string() + ": cannot open attribute steps"), std::string::npos) << attribute;
}

}  // namespace
}  // namespace rhexis
