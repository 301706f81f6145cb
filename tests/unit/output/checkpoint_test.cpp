// SPDX-License-Identifier: BSD-3-Clause
// Restart from a checkpoint on other numbers of ranks; all comparisons are exact.
#include "output/checkpoint.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/error.hpp"
#include "output/hdf5_file.hpp"
#include "small_disk.hpp"
#include "synthetic_source.hpp"
#include "temporary_directory.hpp"

namespace rhexis {
namespace {

using output::CheckpointReader;
using output::CheckpointWriter;
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
TablePart divided_table(const Communicator& ranks, int parts) {
  return test::divided_table(table_rows, table_words, ranks, parts);
}

std::vector<double> numbers(const IdRanges& ids) {
  std::vector<double> values;
  for (const IdRange& range : ids.ranges) {
    for (std::int64_t id = range.first; id < range.first + range.count; ++id)
      values.push_back(1.0 / static_cast<double>(1 + id));
  }
  return values;
}

std::vector<std::uint16_t> words(const TablePart& part) {
  std::vector<std::uint16_t> values;
  for (const IdRange& range : part.rows.ranges) {
    for (std::int64_t r = range.first; r < range.first + range.count; ++r) {
      for (std::int64_t w = 0; w < part.count; ++w)
        values.push_back(static_cast<std::uint16_t>(60000 + r * table_words + part.first + w));
    }
  }
  return values;
}

void write_checkpoint(const std::filesystem::path& path, const Communicator& ranks, int parts) {
  const IdRanges layout = test::divided(columns, rows, ranks, parts);
  const TablePart block = divided_table(ranks, parts);
  CheckpointWriter writer(path, "1.2.3", ranks);
  writer.write("velocity_x", layout, numbers(layout));
  writer.write("bonds", block, words(block));
  writer.write("step", std::numeric_limits<std::int64_t>::max());
  writer.write("time_s", odd_number);
  writer.write("happened", true);
  writer.write("onset", std::optional<double>(0.0));
  writer.write("never", std::optional<double>());
  writer.write("input", std::string("vessel = \"å\"\n"));
  writer.write("nothing", std::string());
  writer.close();
}

void expect_checkpoint(const std::filesystem::path& path, const Communicator& ranks, int parts) {
  const IdRanges layout = test::divided(columns, rows, ranks, parts);
  const TablePart block = divided_table(ranks, parts);
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
  bool happened = false;
  std::optional<double> onset, never = 7;
  reader.read("happened", happened);
  reader.read("onset", onset);
  reader.read("never", never);
  EXPECT_TRUE(happened);
  EXPECT_EQ(onset, 0.0);
  EXPECT_EQ(never, std::nullopt);
  EXPECT_TRUE(reader.holds("step") && reader.holds("bonds") && reader.holds("input"));
  EXPECT_FALSE(reader.holds("never"));
}

TEST(Checkpoint, HoldsRangesOfAnyLength) {
  const TemporaryDirectory directory;
  const IdRanges written = test::dealt_out(150, world), read = test::divided(10, 15, world, 1);
  {
    CheckpointWriter writer(directory / "c.h5", "1.2.3", world);
    writer.write("x", written, numbers(written));
    writer.close();
  }
  CheckpointReader reader(directory / "c.h5", world);
  std::vector<double> values(static_cast<std::size_t>(read.local_count()));
  reader.read("x", read, values);
  EXPECT_EQ(values, numbers(read));
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
    CheckpointWriter writer(directory / "state.h5", "1.2.3", world);
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
  const IdRanges layout = test::divided(200, 100, world, 1);
  const std::vector<double> values(static_cast<std::size_t>(layout.local_count()));
  const std::string message = test::message_of<RunError>([&] {
    CheckpointWriter writer(directory / "state.h5", "1.2.3", world);
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
      test::message_of<RunError>([&] { CheckpointWriter(directory / "no/state.h5", "1.2.3", world); });
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
  const IdRanges longer = test::divided(columns, rows + 1, world, 1);
  std::vector<double> values(static_cast<std::size_t>(longer.local_count()));
  std::int64_t number = 0;
  const std::string shape = test::message_of<InputError>([&] { reader.read("velocity_x", longer, values); });
  EXPECT_EQ(shape, path.string() + ": 'velocity_x' holds 288 values, but this run has 297");
  const std::string missing =
      test::message_of<InputError>([&] { reader.read("velocity_y", longer, values); });
  EXPECT_NE(missing.find(path.string() + ": cannot open data set velocity_y"), std::string::npos) << missing;
  const std::string attribute = test::message_of<InputError>([&] { reader.read("steps", number); });
  EXPECT_EQ(attribute, path.string() + ": it does not hold 'steps'");
}

TEST(Checkpoint, NumbersThatMakeNoSenseAreNamed) {
  const TemporaryDirectory directory;
  const auto path = directory / "state.h5";
  const IdRanges layout = test::divided(columns, rows, world, 1);
  {
    CheckpointWriter writer(path, "1.2.3", world);
    std::vector<double> values = numbers(layout);
    if (!values.empty()) values.back() = std::numeric_limits<double>::infinity();
    writer.write("displacement", layout, values);
    writer.write("step", std::int64_t{-1});
    writer.write("share", 1.5);
    writer.write("energy", std::numeric_limits<double>::quiet_NaN());
    writer.close();
  }
  CheckpointReader reader(path, world);
  const auto message = [&](const auto& read) {
    const std::string text = test::message_of<InputError>(read);
    EXPECT_EQ(text.substr(0, path.string().size() + 2), path.string() + ": ");
    return text.substr(path.string().size() + 2);
  };
  std::int64_t step = 0;
  double number = 0;
  bool flag = false;
  std::vector<double> values(static_cast<std::size_t>(layout.local_count()));
  EXPECT_EQ(message([&] { reader.read("step", step, 0); }).substr(0, 29), "'step' is -1, which makes no ");
  EXPECT_EQ(message([&] { reader.read("step", flag); }).substr(0, 29), "'step' is -1, which makes no ");
  EXPECT_EQ(message([&] { reader.read("share", number, 0, 1); }),
            "'share' is 1.5, which makes no sense (0 to 1 does)");
  EXPECT_EQ(message([&] { reader.read("energy", number); }).substr(0, 31), "'energy' is nan, which makes no");
  EXPECT_EQ(message([&] { reader.read("share", step); }), "'share' is a number of another kind");
  EXPECT_EQ(message([&] { reader.read("displacement", layout, values); }),
            "'displacement' holds values that are not finite");
}

/// Changes the byte at `offset` from the end of the first place where `bytes` stand.
void damage(const std::filesystem::path& path, const std::string& bytes, std::size_t offset) {
  if (world.is_root()) {
    std::string text = test::text_of(path);
    const std::size_t place = text.find(bytes);
    ASSERT_NE(place, std::string::npos);
    text[place + bytes.size() - 1 - offset] ^= 0x10;
    std::ofstream(path, std::ios::binary) << text;
  }
  world.barrier();
}

TEST(Checkpoint, DamageIsRefusedWithTheNameOfWhatItHit) {
  const TemporaryDirectory directory;
  const auto path = directory / "state.h5";
  const auto bytes_of = [](const auto& value) {
    return std::string(reinterpret_cast<const char*>(&value), sizeof value);
  };
  const IdRanges layout = test::divided(columns, rows, world, 1);
  const TablePart block = divided_table(world, 1);
  std::vector<double> values(static_cast<std::size_t>(layout.local_count()));
  std::vector<std::uint16_t> bonds(static_cast<std::size_t>(block.local_count()));
  std::string text;
  const auto damaged = [&](const std::string& bytes, const auto& read) {
    write_checkpoint(path, world, 1);
    damage(path, bytes, 0);
    return test::message_of<InputError>([&] {
      CheckpointReader reader(path, world);
      read(reader);
    });
  };
  const std::string start = path.string() + ": the checkpoint is damaged: ",
                    end = " does not have its checksum";
  EXPECT_EQ(damaged(bytes_of(1.0 / 7), [&](auto& r) { r.read("velocity_x", layout, values); }),
            start + "'velocity_x'" + end);
  EXPECT_EQ(damaged(bytes_of(std::uint16_t{60007}) + bytes_of(std::uint16_t{60008}),
                    [&](auto& r) { r.read("bonds", block, bonds); }),
            start + "'bonds'" + end);
  EXPECT_EQ(damaged("vessel = ", [&](auto& r) { r.read("input", text); }), start + "'input'" + end);
  // The numbers are among HDF5's own structures, which have checksums of their own.
  EXPECT_EQ(damaged(bytes_of(odd_number), [](auto&) {}).substr(0, path.string().size() + 2),
            path.string() + ": ");
}

TEST(Checkpoint, AnotherFormatIsToldWithItsWriter) {
  const TemporaryDirectory directory;
  const auto path = directory / "state.h5";
  const auto message = [&](const std::string& format, const std::string& writer) {
    if (world.is_root()) {
      output::change_structure(path, output::Hdf5File::Mode::create, 0, [&](output::Hdf5File& file) {
        file.write_attribute("/", "format", format);
        if (!writer.empty()) file.write_attribute("/", "program_version", writer);
      });
    }
    world.barrier();
    return test::message_of<InputError>([&] { CheckpointReader(path, world); }).substr(path.string().size());
  };
  EXPECT_EQ(
      message("rhexis checkpoint 5", ""),
      ": a checkpoint of format 5, which an earlier version of Rhexis wrote; this one reads format 6 alone: "
      "go on with that version, or start anew");
  EXPECT_NE(message("rhexis checkpoint 7", "9.8.7")
                .find("a checkpoint of format 7, which version 9.8.7 of Rhexis wrote"),
            std::string::npos);
  EXPECT_EQ(message("something else", ""),
            ": not a checkpoint of Rhexis: its attribute 'format' is missing or says something else");
}

}  // namespace
}  // namespace rhexis
