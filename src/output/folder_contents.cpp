// SPDX-License-Identifier: BSD-3-Clause
#include "output/folder_contents.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <sstream>

#include "core/error.hpp"
#include "core/text_file.hpp"

namespace rhexis::output {
namespace {

namespace fs = std::filesystem;

constexpr const char* samples = "samples.csv";

/// Whole rows below the header of an ensemble's table.
bool holds_samples(const fs::path& directory) {
  if (!fs::is_regular_file(directory / samples)) return false;
  std::istringstream table(whole_file(directory / samples));
  std::string line;
  return std::getline(table, line) && std::getline(table, line) && !table.eof();
}

std::string list_of(const std::vector<std::string>& names) {
  constexpr std::size_t shown = 5;
  const std::vector<std::string> first(
      names.begin(), names.begin() + static_cast<std::ptrdiff_t>(std::min(shown, names.size())));
  return fmt::format("{}{}", fmt::join(first, ", "),
                     names.size() > shown ? fmt::format(" and {} more", names.size() - shown) : "");
}

}  // namespace

void refuse_results(const fs::path& path, const std::string& reason, const std::string& remedy) {
  throw InputError(fmt::format("cannot write results to {}: {}; {}", path.string(), reason, remedy));
}

bool is_folder(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) return true;
  if (fs::exists(status)) refuse_results(path, "it is a file, not a folder");
  if (fs::is_symlink(fs::symlink_status(path, error)))
    refuse_results(path, "it is a link that leads nowhere");
  return false;
}

std::vector<std::string> entries_of(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
    names.push_back(entry.path().filename().string());
  return names;
}

FolderContents::FolderContents(const FolderPlan& plan)
    : directory_(plan.directory), overwrite_(plan.overwrite), reads_(identities(plan.reads)) {
  for (fs::path path = directory_; !is_folder(path) && path.has_parent_path(); path = path.parent_path()) {
  }
  const bool for_samples = std::ranges::find(plan.writes.names, samples) != plan.writes.names.end();
  if (plan.earlier == EarlierResults::remove && !for_samples && holds_samples(directory_)) {
    refuse_results(directory_, "it holds the samples of an ensemble",
                   "move samples.csv away, or choose another folder with -o");
  }
  try {
    manifest = read_manifest(directory_);
  } catch (const InputError& error) {
    if (!overwrite_)
      refuse_results(directory_, error.what(),
                     "move that file away, replace it with --overwrite, or choose another folder with -o");
  }
  for (const char* folder : standing_folders) refuse_detour(std::string(folder) + "/x");
  refuse_obstacles(std::vector<std::string>{Manifest::file_name});
  refuse_obstacles(plan.writes);
}

void FolderContents::refuse_obstacles(const FutureFiles& files) const {
  std::vector<std::string> names = files.names;
  for (const std::string folder : standing_folders) {
    for (const std::string& entry : entries_of(directory_ / folder)) {
      if (const std::string name = folder + "/" + entry; files.may_be_written(name)) names.push_back(name);
    }
  }
  refuse_obstacles(names);
}

void FolderContents::refuse_obstacles(const std::vector<std::string>& names) const {
  std::vector<std::string> read, foreign;
  for (const std::string& name : names) {
    refuse_detour(name);
    struct stat status {};
    const fs::path path = directory_ / name;
    if (lstat(path.c_str(), &status) != 0) {
      if (errno != ENOENT) refuse_results(path, std::strerror(errno));
      continue;
    }
    if (S_ISDIR(status.st_mode))
      refuse_results(path, "it is a folder, and the run writes a file of this name");
    if (is_read(path)) read.push_back(name);
    if (!is_ours(name) && !overwrite_) foreign.push_back(name);
  }
  if (!read.empty())
    refuse_results(directory_, fmt::format("the run reads {} and would replace {}", list_of(read),
                                           read.size() > 1 ? "them" : "it"));
  if (!foreign.empty()) {
    refuse_results(
        directory_,
        fmt::format("{} would be replaced, and no earlier run made {}", list_of(foreign),
                    foreign.size() > 1 ? "them" : "it"),
        fmt::format("move {0} away, replace {0} with --overwrite, or choose another folder with -o",
                    foreign.size() > 1 ? "them" : "it"));
  }
}

bool FolderContents::is_read(const fs::path& path) const {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 && reads_.contains(Identity(status.st_dev, status.st_ino));
}

std::set<FolderContents::Identity> FolderContents::identities(const std::vector<fs::path>& paths) {
  std::set<Identity> all;
  const auto add = [&](const fs::path& path) {
    struct stat status {};
    if (stat(path.c_str(), &status) == 0) all.emplace(status.st_dev, status.st_ino);
  };
  for (const fs::path& path : paths) {
    add(path);
    std::error_code ignored;
    if (!fs::is_directory(path, ignored)) continue;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path, ignored))
      add(entry.path());
  }
  return all;
}

bool FolderContents::is_ours(const std::string& name) const {
  return manifest.files.contains(name) || name == Manifest::file_name;
}

fs::path FolderContents::detour(const std::string& name) const {
  for (std::size_t slash = name.find('/'); slash != std::string::npos; slash = name.find('/', slash + 1)) {
    const fs::path folder = directory_ / name.substr(0, slash);
    struct stat status {};
    if (lstat(folder.c_str(), &status) == 0 && !S_ISDIR(status.st_mode)) return folder;
  }
  return {};
}

void FolderContents::refuse_detour(const std::string& name) const {
  const fs::path folder = detour(name);
  if (folder.empty()) return;
  refuse_results(folder, fs::is_symlink(folder)
                             ? "it is a link, and links inside a results folder are not followed"
                             : "it is a file, not a folder");
}

}  // namespace rhexis::output
