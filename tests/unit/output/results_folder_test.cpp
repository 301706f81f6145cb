// SPDX-License-Identifier: BSD-3-Clause
#include "output/results_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.hpp"
#include "output/manifest.hpp"
#include "output/temporary_file.hpp"
#include "temporary_directory.hpp"

namespace rhexis {
namespace {

namespace fs = std::filesystem;
using output::EarlierResults;
using output::FolderPlan;
using output::ResultsFolder;
using test::TemporaryDirectory;
using test::text_of;

const parallel::Communicator world = parallel::Communicator::world();

/// The message of a refusal, "" if there is none.
std::string refusal(const FolderPlan& plan) {
  const std::string message = test::message_of<InputError>([&] { ResultsFolder(plan, world); });
  world.barrier();
  return message;
}

std::string refusal(const fs::path& directory) {
  return refusal(FolderPlan{.directory = directory});
}

/// Does something on the root, before any rank goes on.
template <class Action>
void once(Action action) {
  world.barrier();
  if (world.is_root()) action();
  world.barrier();
}

void make_files(const fs::path& directory, const std::vector<std::string>& names) {
  once([&] {
    for (const std::string& name : names) {
      fs::create_directories((directory / name).parent_path());
      std::ofstream(directory / name) << "old";
    }
  });
}

/// A run that leaves these files, with what they hold.
void earlier_run(const fs::path& directory, const std::vector<std::string>& names,
                 const std::string& text = "ours") {
  world.barrier();
  const ResultsFolder folder({.directory = directory}, world);
  folder.remove_earlier_results();
  for (const std::string& name : names) {
    const fs::path path = folder.claim(name);
    once([&] { std::ofstream(path) << text; });
  }
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::vector<std::string> entries(const fs::path& directory) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(directory)) names.push_back(entry.path().filename());
  std::ranges::sort(names);
  return names;
}

TEST(ResultsFolder, IsMadeWithItsParentsAndParts) {
  const TemporaryDirectory directory;
  {
    const ResultsFolder folder({.directory = directory / "a/b/"}, world);
    EXPECT_EQ(entries(directory / "a/b"), (std::vector<std::string>{"checkpoints", "images"}));
    world.barrier();
    folder.remove_earlier_results();
    world.barrier();
  }
  EXPECT_EQ(entries(directory / "a/b"), (std::vector<std::string>{"checkpoints", "images", "manifest.txt"}));
}

TEST(ResultsFolder, IsTakenBackWhereTheRunDoesNotBegin) {
  const TemporaryDirectory directory;
  { const ResultsFolder folder({.directory = directory / "a/b/"}, world); }
  world.barrier();
  EXPECT_TRUE(fs::is_empty(directory.path()));
  make_files(directory / "c", {"mine"});
  { const ResultsFolder folder({.directory = directory / "c"}, world); }
  world.barrier();
  EXPECT_EQ(entries(directory / "c"), std::vector<std::string>{"mine"});
}

TEST(ResultsFolder, RemovesWhatEarlierRunsMadeAndNothingElse) {
  const TemporaryDirectory directory;
  const std::vector<std::string> ours = {"run.json", "images/vessel_0001.png", "images/deeper/a.png",
                                         "event_02/run.json"};
  const std::vector<std::string> kept = {"checkpoints/step_000100.h5", "event_02/checkpoints/step_000100.h5"};
  earlier_run(directory.path(), ours);
  for (const std::string& name : ours) EXPECT_TRUE(fs::exists(directory / name)) << name;
  {
    const ResultsFolder restart({.directory = directory.path(), .earlier = EarlierResults::keep}, world);
    restart.remove_earlier_results();
    for (const std::string& name : kept) {
      const fs::path path = restart.claim(name);
      once([&] { std::ofstream(path) << "ours"; });
    }
    for (const std::string& name : ours) EXPECT_TRUE(fs::exists(directory / name)) << name;
  }
  const std::vector<std::string> others = {
      "notes.txt",        "particles.h5",         "movie.mp4",         "vessels.csv",
      "images/a_001.png", "images/deeper/mine",   "event_03/run.json", "event_2024/history.csv",
      "run.json.part",    "checkpoints/000100.h5"};
  make_files(directory.path(), others);
  earlier_run(directory.path(), {"history.csv"});
  for (const std::string& name : ours) EXPECT_FALSE(fs::exists(directory / name)) << name;
  for (const std::string& name : kept) EXPECT_TRUE(fs::exists(directory / name)) << name;
  for (const std::string& name : others) EXPECT_EQ(text_of(directory / name), "old") << name;
  // What is left of a folder that runs made is known yet.
  earlier_run(directory.path(), {});
  once([&] { fs::remove_all(directory / "event_02/checkpoints"); });
  earlier_run(directory.path(), {});
  EXPECT_FALSE(fs::exists(directory / "event_02"));
  EXPECT_TRUE(fs::exists(directory / "images/deeper/mine"));
}

TEST(ResultsFolder, AFileThatNoRunMadeIsRefusedWithItsName) {
  const TemporaryDirectory directory;
  earlier_run(directory.path(), {"run.json"});
  make_files(directory.path(), {"history.csv", "vessels.csv", "checkpoints/step_000007.h5"});
  FolderPlan plan{.directory = directory.path(), .writes = {.names = {"run.json", "history.csv"}}};
  const std::string message = refusal(plan);
  EXPECT_TRUE(contains(message,
                       "history.csv would be replaced, and no earlier run made it; move it away, replace "
                       "it with --overwrite, or choose another folder with -o"))
      << message;
  EXPECT_FALSE(contains(message, "run.json") || contains(message, "vessels.csv")) << message;
  EXPECT_EQ(text_of(directory / "run.json"), "ours");
  plan.writes = {
      .may_be_written = [](const std::string& name) { return name == "checkpoints/step_000007.h5"; }};
  EXPECT_TRUE(contains(refusal(plan), "checkpoints/step_000007.h5 would be replaced"));
  EXPECT_EQ(test::message_of<InputError>([&] { output::refuse_obstacles(plan, world); }), refusal(plan));
  plan.overwrite = true;
  EXPECT_EQ(refusal(plan), "");
  // A file may also appear later.
  plan = {.directory = directory.path()};
  const ResultsFolder folder(plan, world);
  EXPECT_TRUE(contains(test::message_of<InputError>([&] { folder.will_write({.names = {"vessels.csv"}}); }),
                       "vessels.csv would be replaced"));
  folder.remove_earlier_results();
  EXPECT_TRUE(contains(test::message_of<InputError>([&] { folder.claim("vessels.csv"); }),
                       "vessels.csv would be replaced"));
  EXPECT_EQ(text_of(directory / "vessels.csv"), "old");
}

TEST(ResultsFolder, AFileThatTheRunReadsIsNeverTouched) {
  const TemporaryDirectory directory;
  earlier_run(directory.path(), {"vessels.csv", "network.h5"});
  make_files(directory / "package", {"part.py"});
  once([&] {
    fs::create_hard_link(directory / "package/part.py", directory / "images/part.py");
    fs::create_symlink("vessels.csv", directory / "link.csv");
  });
  FolderPlan plan{.directory = directory.path(),
                  .overwrite = true,
                  .reads = {directory / "link.csv", directory / "package"},
                  .writes = {.names = {"network.h5", "vessels.csv"}}};
  EXPECT_TRUE(
      contains(refusal(plan), "the run reads vessels.csv and would replace it; choose another folder"));
  plan.writes.names = {"images/part.py"};
  EXPECT_TRUE(contains(refusal(plan), "the run reads images/part.py"));
  plan.writes.names = {};
  const ResultsFolder folder(plan, world);
  folder.remove_earlier_results();
  EXPECT_EQ(text_of(directory / "vessels.csv"), "ours");
  EXPECT_FALSE(fs::exists(directory / "network.h5"));
  EXPECT_NE(test::message_of<InputError>([&] { folder.claim("vessels.csv"); }), "");
}

TEST(ResultsFolder, LinksInsideAreNotFollowed) {
  const TemporaryDirectory directory;
  earlier_run(directory / "r", {"run.json", "event_01/run.json"});
  make_files(directory / "victim", {"file", "run.json"});
  once([&] {
    fs::remove(directory / "r/run.json");
    fs::create_symlink("../victim/file", directory / "r/run.json");
    fs::create_symlink("../victim/nothing", directory / "r/history.csv");
    fs::remove_all(directory / "r/event_01");
    fs::create_symlink("../victim", directory / "r/event_01");
  });
  FolderPlan plan{.directory = directory / "r", .writes = {.names = {"event_01/run.json"}}};
  EXPECT_TRUE(contains(refusal(plan),
                       "r/event_01: it is a link, and links inside a results folder are not followed"));
  plan.writes.names = {"history.csv"};
  EXPECT_TRUE(contains(refusal(plan), "history.csv would be replaced"));
  // What an earlier run made goes; the user's own link, and what links point at, stay.
  earlier_run(directory / "r", {});
  EXPECT_EQ(entries(directory / "r"),
            (std::vector<std::string>{"checkpoints", "event_01", "history.csv", "images", "manifest.txt"}));
  EXPECT_EQ(text_of(directory / "victim/file") + text_of(directory / "victim/run.json"), "oldold");
  once([&] {
    fs::remove(directory / "r/images");
    fs::create_symlink("../victim", directory / "r/images");
  });
  EXPECT_TRUE(contains(refusal(directory / "r"), "r/images: it is a link"));
  once([&] { fs::create_symlink("nowhere", directory / "dangling"); });
  EXPECT_TRUE(contains(refusal(directory / "dangling"), "dangling: it is a link that leads nowhere"));
}

TEST(ResultsFolder, UnfinishedFilesOfAKilledRunGo) {
  const TemporaryDirectory directory;
  std::string left;
  {
    const ResultsFolder killed({.directory = directory.path()}, world);
    killed.remove_earlier_results();
    const fs::path history = killed.claim("history.csv");
    once([&] {
      left = output::temporary_beside(history).filename();
      fs::create_directories(output::temporary_name_beside(directory / "images/pictures") / "deeper");
      std::ofstream(directory / ".history.csv.0123456789abcdef-1") << "old";
    });
  }
  EXPECT_EQ(entries(directory / "images").size(), 1);
  earlier_run(directory.path(), {});
  once([&] {
    EXPECT_FALSE(fs::exists(directory / left));
    EXPECT_TRUE(fs::is_empty(directory / "images"));
    EXPECT_TRUE(fs::exists(directory / ".history.csv.0123456789abcdef-1"));
  });
}

TEST(ResultsFolder, ADamagedManifestIsRefusedWithItsName) {
  const std::pair<const char*, const char*> damages[] = {
      {"notes of mine\n", "its first line should be"},
      {"rhexis results 1\nfile ../secret\n", "manifest.txt:2: 'file ../secret': a name has no empty part"},
      {"rhexis results 1\nfile a\nfile /etc/passwd\n",
       "manifest.txt:3: 'file /etc/passwd': a name is relative"},
      {"rhexis results 1\nfile a//b\n", "empty part"},
      {"rhexis results 1\nfolder images/\n", "does not end in '/'"},
      {"rhexis results 1\nfile a\rb\n", "no control characters"},
      {"rhexis results 1\nrun 12\n", "16 hexadecimal digits"},
      {"rhexis results 1\nfile\n", "relative to the results folder"},
      {"rhexis results 1\nfiles a\n", "an entry is"}};
  for (const auto& [text, reason] : damages) {
    const TemporaryDirectory directory;
    once([&, &text = text] { std::ofstream(directory / "manifest.txt") << text; });
    const std::string message = refusal(directory.path());
    EXPECT_TRUE(contains(message, reason)) << message;
    EXPECT_TRUE(contains(message, "choose another folder with -o")) << message;
    EXPECT_EQ(text_of(directory / "manifest.txt"), text);
    EXPECT_EQ(refusal(FolderPlan{.directory = directory.path(), .overwrite = true}), "");
  }
}

TEST(ResultsFolder, AManifestsLineThatACrashCutShortDoesNotCount) {
  const TemporaryDirectory directory;
  make_files(directory.path(), {"history.csv", "hist"});
  once([&] { std::ofstream(directory / "manifest.txt") << "rhexis results 1\nfile history.csv\nfile hist"; });
  earlier_run(directory.path(), {});
  EXPECT_FALSE(fs::exists(directory / "history.csv"));
  EXPECT_TRUE(fs::exists(directory / "hist"));
}

TEST(ResultsFolder, NamesOfResultsStayInside) {
  const TemporaryDirectory directory;
  const ResultsFolder folder({.directory = directory / "r"}, world);
  folder.remove_earlier_results();
  for (const char* name : {"../a", "/a", "a/../../b", "a\nfile b", ""})
    EXPECT_NE(test::message_of<InputError>([&] { folder.claim(name); }), "") << name;
  const std::string long_name(300, 'a');
  EXPECT_TRUE(contains(test::message_of<InputError>([&] { folder.claim(long_name); }), "File name too long"));
  const ResultsFolder event = folder.subfolder("event_01");
  EXPECT_EQ(event.claim("checkpoints/a.h5"), directory / "r/event_01/checkpoints/a.h5");
  EXPECT_TRUE(fs::is_directory(directory / "r/event_01/checkpoints"));
}

TEST(ResultsFolder, ARestartDropsWhatCameAfterItsCheckpoint) {
  const TemporaryDirectory directory;
  earlier_run(directory.path(), {"event_01/run.json", "event_02/run.json", "event_02/checkpoints/a.h5"});
  const ResultsFolder restart(
      {.directory = directory.path(),
       .earlier = EarlierResults::keep,
       .drops = [](const std::string& name) { return name.starts_with("event_02/"); }},
      world);
  EXPECT_TRUE(fs::exists(directory / "event_02/run.json"));
  world.barrier();
  restart.remove_earlier_results();
  EXPECT_FALSE(fs::exists(directory / "event_02/run.json"));
  EXPECT_TRUE(fs::exists(directory / "event_01/run.json"));
  EXPECT_TRUE(fs::exists(directory / "event_02/checkpoints/a.h5"));
}

TEST(ResultsFolder, SamplesOfAnEnsembleAreNotRemoved) {
  const TemporaryDirectory directory;
  earlier_run(directory.path(), {"samples.csv"}, "wall\n1\n");
  EXPECT_TRUE(contains(refusal(directory.path()), "samples of an ensemble"));
  EXPECT_EQ(refusal(FolderPlan{.directory = directory.path(), .earlier = EarlierResults::keep}), "");
  once([&] { std::ofstream(directory / "samples.csv") << "wall\n1"; });  // cut short: none
  EXPECT_EQ(refusal(directory.path()), "");
}

TEST(ResultsFolder, IsForOneRunAtATime) {
  const TemporaryDirectory directory;
  const ResultsFolder held({.directory = directory / "a"}, world);
  EXPECT_TRUE(contains(refusal(directory / "a"), "another run is still writing there"));
  EXPECT_EQ(refusal(directory / "b"), "");
}

TEST(ResultsFolder, AFileInItsPlaceIsAnErrorOnAllRanks) {
  const TemporaryDirectory directory;
  make_files(directory.path(), {"file", "run/checkpoints"});
  const std::string path = (directory / "file").string();
  const std::string expected =
      "cannot write results to " + path + ": it is a file, not a folder; choose another folder with -o";
  EXPECT_EQ(refusal(path), expected);
  EXPECT_EQ(refusal(path + "/a/b"), expected);
  EXPECT_TRUE(contains(refusal(directory / "run"), "run/checkpoints: it is a file, not a folder"));
  EXPECT_FALSE(fs::exists(directory / "run/images"));
  once([&] { fs::create_directories(directory / "other/run.json"); });
  const std::string folder = refusal(FolderPlan{.directory = directory / "other", .writes = {{"run.json"}}});
  EXPECT_TRUE(contains(folder, "run.json: it is a folder")) << folder;
}

// Where even the superuser cannot write.
TEST(ResultsFolder, AFolderThatCannotBeMadeOrWrittenIsAnErrorOnAllRanks) {
  EXPECT_TRUE(contains(refusal("/proc/rhexis/a"), "cannot write results to /proc/rhexis: "));
  EXPECT_TRUE(contains(refusal("/proc/self"), "cannot write results to /proc/self"));
  EXPECT_NE(refusal(""), "");
  const TemporaryDirectory directory;
  EXPECT_TRUE(contains(refusal(directory / std::string(300, 'a')), "File name too long"));
  EXPECT_TRUE(contains(refusal(directory / std::string(4000, 'a')), "File name too long"));
}

}  // namespace
}  // namespace rhexis
