#include "output/directory.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "temporary_directory.hpp"

namespace rhexis {
namespace {

namespace fs = std::filesystem;
using output::EarlierResults;
using output::prepare_directory;
using test::TemporaryDirectory;

const parallel::Communicator world = parallel::Communicator::world();

std::string refusal(const fs::path& directory) {
  return test::message_of<InputError>([&] { prepare_directory(directory, EarlierResults::remove, world); });
}

/// Makes files on the root, before any rank goes on.
void make_files(const fs::path& directory, const std::vector<std::string>& names) {
  if (world.is_root()) {
    for (const std::string& name : names) {
      fs::create_directories((directory / name).parent_path());
      std::ofstream(directory / name) << "old";
    }
  }
  world.barrier();
}

TEST(Directory, IsMadeWithItsParentsAndParts) {
  const TemporaryDirectory directory;
  prepare_directory(directory / "a/b/", EarlierResults::remove, world);
  EXPECT_TRUE(fs::is_directory(directory / "a/b/images"));
  EXPECT_TRUE(fs::is_directory(directory / "a/b/checkpoints"));
  EXPECT_FALSE(fs::exists(directory / "a/b/.rhexis-write-test"));
  EXPECT_EQ(std::distance(fs::directory_iterator(directory / "a/b"), {}), 2);
}

TEST(Directory, SamplesOfAnEnsembleAreNotRemoved) {
  const TemporaryDirectory directory;
  make_files(directory.path(), {"run.json"});
  if (world.is_root()) std::ofstream(directory / "samples.csv") << "wall\n1\n";
  world.barrier();
  EXPECT_NE(refusal(directory.path()).find("samples of an ensemble"), std::string::npos);
  EXPECT_TRUE(fs::exists(directory / "samples.csv") && fs::exists(directory / "run.json"));
  EXPECT_FALSE(fs::exists(directory / "images"));
  world.barrier();
  prepare_directory(directory.path(), EarlierResults::keep, world);
}

TEST(Directory, ASampleThatWasCutShortIsNone) {
  const TemporaryDirectory directory;
  if (world.is_root()) std::ofstream(directory / "samples.csv") << "wall\n1";
  world.barrier();
  prepare_directory(directory.path(), EarlierResults::remove, world);
  EXPECT_FALSE(fs::exists(directory / "samples.csv"));
}

TEST(Directory, IsForOneRunAtATime) {
  const TemporaryDirectory directory;
  const auto held = prepare_directory(directory / "a", EarlierResults::remove, world);
  make_files(directory / "a", {"run.json"});
  EXPECT_NE(refusal(directory / "a").find("another run is still writing there"), std::string::npos);
  EXPECT_TRUE(fs::exists(directory / "a/run.json"));
  prepare_directory(directory / "b", EarlierResults::remove, world);
}

TEST(Directory, SamplesThatCannotBeReadAreNotTakenForNone) {
  const TemporaryDirectory directory;
  if (world.is_root())
    fs::create_directory(directory / "samples.csv");  // root may read any file, but no folder
  world.barrier();
  EXPECT_NE(refusal(directory.path()).find("samples.csv: cannot be read: "), std::string::npos);
}

TEST(Directory, ResultsOfAnEarlierRunGoAndNothingElse) {
  const TemporaryDirectory directory;
  const std::vector<std::string> ours = {"run.json",       "history.csv",
                                         "particles.xdmf", "particles.h5",
                                         "network.h5",     "network.xdmf",
                                         "movie.mp4",      "images/vessel_0001.png",
                                         "run.json.part",  "particles_from_000100.h5",
                                         "cascade.csv",    "event_02/run.json",
                                         "samples.csv"};  // one line: a header only
  const std::vector<std::string> others = {
      "notes.txt",         "particles_from_me.txt", "other.h5",        "picture.png",
      "images/notes.txt",  "images/deeper/a.png",   "images/mine.png", "checkpoints/000100.h5",
      "event_03/mine.csv", "event_of_mine/run.json"};
  make_files(directory.path(), ours);
  make_files(directory.path(), others);
  prepare_directory(directory.path(), EarlierResults::keep, world);
  for (const std::string& name : ours) EXPECT_TRUE(fs::exists(directory / name)) << name;
  world.barrier();
  prepare_directory(directory.path(), EarlierResults::remove, world);
  for (const std::string& name : ours) EXPECT_FALSE(fs::exists(directory / name)) << name;
  for (const std::string& name : others) EXPECT_TRUE(fs::exists(directory / name)) << name;
  EXPECT_FALSE(fs::exists(directory / "event_02"));
}

TEST(Directory, AFileInItsPlaceIsAnErrorOnAllRanks) {
  const TemporaryDirectory directory;
  make_files(directory.path(), {"file", "run/checkpoints"});
  const std::string path = (directory / "file").string();
  EXPECT_EQ(refusal(path), "cannot write results to " + path + ": it is a file, not a folder");
  EXPECT_EQ(refusal(path + "/a/b"), "cannot write results to " + path + ": it is a file, not a folder");
  EXPECT_NE(refusal(directory / "run").find("run/checkpoints: it is a file"), std::string::npos);
  // The attempt made images/ before it met the file.
  EXPECT_FALSE(fs::exists(directory / "run/images"));
}

TEST(Directory, ARefusalLeavesOldResultsAlone) {
  const TemporaryDirectory directory;
  make_files(directory.path(), {"run.json", "images"});
  EXPECT_NE(refusal(directory.path()), "");
  EXPECT_TRUE(fs::exists(directory / "run.json"));
}

// Where even the superuser cannot write.
TEST(Directory, AFolderThatCannotBeMadeOrWrittenIsAnErrorOnAllRanks) {
  EXPECT_NE(refusal("/proc/rhexis/a").find("cannot write results to /proc/rhexis: "), std::string::npos);
  EXPECT_NE(refusal("/proc/self").find("cannot write results to /proc/self"), std::string::npos);
  EXPECT_NE(refusal(""), "");
}

}  // namespace
}  // namespace rhexis
