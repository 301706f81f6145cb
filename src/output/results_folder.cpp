// SPDX-License-Identifier: BSD-3-Clause
#include "output/results_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <climits>
#include <cstring>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "core/error.hpp"
#include "output/atomic_file.hpp"
#include "output/folder_contents.hpp"
#include "output/manifest.hpp"
#include "output/temporary_file.hpp"
#include "parallel/together.hpp"

namespace rhexis::output {
namespace {

namespace fs = std::filesystem;

/// Room for what is written into a results folder, in bytes of a path: pictures in a folder of their own, and
/// temporary names.
constexpr std::size_t longest_name_inside = 512;

/// Folders made by this run, innermost last; taken back unless they are kept.
class NewFolders {
 public:
  NewFolders() = default;
  NewFolders(const NewFolders&) = delete;
  NewFolders& operator=(const NewFolders&) = delete;
  ~NewFolders() {
    for (auto path = made_.rbegin(); path != made_.rend(); ++path) rmdir(path->c_str());
  }

  /// Makes `path` with its parents where they are missing.
  void make(const fs::path& path) {
    if (is_folder(path)) return;
    if (path.has_parent_path() && path.parent_path() != path) make(path.parent_path());
    std::error_code error;
    if (fs::create_directory(path, error)) made_.push_back(path);
    if (error) refuse_results(path, error.message());
  }

  void keep() { made_.clear(); }

 private:
  std::vector<fs::path> made_;
};

/// Only an attempt tells: permission bits say nothing about read-only file systems, quotas or the superuser.
void try_to_write_in(const fs::path& directory) {
  errno = 0;
  const fs::path probe = temporary_name_beside(directory / "test");
  const int file = open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) refuse_results(directory, std::strerror(errno));
  const bool written = write(file, "test", 4) == 4;
  const std::string reason = std::strerror(errno);
  close(file);
  unlink(probe.c_str());
  if (!written) refuse_results(directory, reason);
}

/// Held as long as what is returned lives, or until this program ends, however it does.
std::shared_ptr<const void> lock(const fs::path& directory) {
  const int file = open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return nullptr;
  std::shared_ptr<const void> held(nullptr, [file](const void*) { close(file); });
  if (flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    refuse_results(directory, "another run is still writing there",
                   "wait for its end, or choose another folder with -o");
  return held;
}

bool stays(const std::string& name) {
  return name.starts_with("checkpoints/") || name.find("/checkpoints/") != std::string::npos;
}

}  // namespace

/// Shared by the handles. All but `directory` is the root's.
class ResultsFolder::State {
 public:
  State(const FolderPlan& plan, const parallel::Communicator& communicator)
      : directory(plan.directory), comm(communicator), drops_(plan.drops) {
    if (plan.earlier == EarlierResults::remove) drops_ = [](const std::string&) { return true; };
    share_run_token(comm.broadcast(run_token()));
    parallel::on_root<InputError>(comm, [&] {
      if (fs::absolute(directory).string().size() + longest_name_inside > PATH_MAX)
        refuse_results(directory, std::strerror(ENAMETOOLONG));
      made_.make(directory);
      lock_ = lock(directory);
      contents_.emplace(plan);
      try_to_write_in(directory);
      for (const char* folder : standing_folders) {
        made_.make(directory / folder);
        try_to_write_in(directory / folder);
      }
    });
  }

  void refuse_obstacles(const FutureFiles& files) const { contents_->refuse_obstacles(files); }

  void begin() {
    if (begun_) return;
    remove_unfinished();
    remove_files();
    Manifest& manifest = contents_->manifest;
    manifest.tokens = {run_token()};
    list_ = TableFile(directory / Manifest::file_name, manifest.text());
    made_.keep();
    begun_ = true;
  }

  void claim(const std::string& name) {
    assert(begun_);
    if (claimed_.contains(name)) return;
    const std::string fault = fault_of_name(name);
    if (!fault.empty()) throw InputError(fmt::format("'{}' cannot be a result's name: {}", name, fault));
    contents_->refuse_obstacles(std::vector{name});
    for (std::size_t slash = name.find('/'); slash != std::string::npos; slash = name.find('/', slash + 1))
      make_folder(name.substr(0, slash));
    if (contents_->manifest.files.insert(name).second) list_.append(manifest_line("file", name));
    claimed_.insert(name);
  }

  const std::set<std::string>& files() const { return contents_->manifest.files; }

  const fs::path directory;
  const parallel::Communicator comm;

 private:
  void make_folder(const std::string& name) {
    const fs::path path = directory / name;
    if (fs::is_directory(fs::symlink_status(path))) return;
    if (contents_->manifest.folders.insert(name).second) list_.append(manifest_line("folder", name));
    if (mkdir(path.c_str(), 0777) != 0 && errno != EEXIST)
      throw RunError(fmt::format("{}: cannot make the folder: {}", path.string(), std::strerror(errno)));
  }

  void unlink_ours(const fs::path& path) const {
    struct stat status {};
    if (lstat(path.c_str(), &status) != 0 || S_ISDIR(status.st_mode)) return;
    if (unlink(path.c_str()) != 0)
      refuse_results(path,
                     fmt::format("cannot remove the results of an earlier run: {}", std::strerror(errno)));
  }

  /// Removes the temporary files of earlier runs.
  void remove_unfinished() const {
    const Manifest& manifest = contents_->manifest;
    if (manifest.tokens.empty()) return;
    std::set<std::string> folders(std::begin(standing_folders), std::end(standing_folders));
    folders.insert("");
    for (const std::string& folder : manifest.folders) folders.insert(folder);
    for (const std::string& file : manifest.files) folders.insert(fs::path(file).parent_path().string());
    for (const std::string& folder : folders) {
      if (!contents_->is_straight(folder + "/x")) continue;
      for (const std::string& entry : entries_of(directory / folder)) {
        const bool ours = std::ranges::any_of(
            manifest.tokens, [&](const std::string& token) { return is_temporary(entry, token); });
        std::error_code ignored;
        if (ours) fs::remove_all(directory / folder / entry, ignored);
      }
    }
  }

  /// Removes the files of the manifest that go, but checkpoints, then the folders that have become empty.
  void remove_files() {
    Manifest& manifest = contents_->manifest;
    std::erase_if(manifest.files, [&](const std::string& name) {
      const fs::path path = directory / name;
      if (!drops_(name)) return false;
      if (!contents_->is_straight(name)) return true;
      if (stays(name) || contents_->is_read(path)) return !fs::exists(fs::symlink_status(path));
      unlink_ours(path);
      return true;
    });
    for (auto name = manifest.folders.rbegin(); name != manifest.folders.rend();
         ++name) {  // inner ones first
      if (contents_->is_straight(*name + "/x")) rmdir((directory / *name).c_str());
    }
    std::erase_if(manifest.folders, [&](const std::string& name) {
      return !fs::is_directory(fs::symlink_status(directory / name));
    });
  }

  std::function<bool(const std::string& name)> drops_;
  NewFolders made_;
  std::shared_ptr<const void> lock_;
  std::optional<FolderContents> contents_;
  TableFile list_;
  std::set<std::string> claimed_;
  bool begun_ = false;
};

void refuse_obstacles(const FolderPlan& plan, const parallel::Communicator& communicator) {
  parallel::on_root<InputError>(communicator, [&] { const FolderContents unobstructed(plan); });
}

ResultsFolder::ResultsFolder(const FolderPlan& plan, const parallel::Communicator& communicator)
    : state_(std::make_shared<State>(plan, communicator)) {}

ResultsFolder::ResultsFolder(std::shared_ptr<State> state, std::string prefix)
    : state_(std::move(state)), prefix_(std::move(prefix)) {}

void ResultsFolder::will_write(const FutureFiles& files) const {
  parallel::on_root<InputError>(state_->comm, [&] {
    FutureFiles full = files;
    for (std::string& name : full.names) name.insert(0, prefix_);
    state_->refuse_obstacles(full);
  });
}

void ResultsFolder::remove_earlier_results() const {
  parallel::together(state_->comm, [&] {
    if (state_->comm.is_root()) state_->begin();
  });
}

fs::path ResultsFolder::claim(const std::string& name) const {
  parallel::together(state_->comm, [&] {
    if (state_->comm.is_root()) state_->claim(prefix_ + name);
  });
  return path() / name;
}

fs::path ResultsFolder::claim_on_root(const std::string& name) const {
  assert(state_->comm.is_root());
  state_->claim(prefix_ + name);
  return path() / name;
}

std::vector<std::string> ResultsFolder::files_in(const std::string& folder) const {
  assert(state_->comm.is_root());
  const std::string before = prefix_ + folder + "/";
  std::vector<std::string> names;
  for (const std::string& name : state_->files()) {
    if (name.starts_with(before)) names.push_back(name.substr(before.size()));
  }
  return names;
}

ResultsFolder ResultsFolder::subfolder(const std::string& name) const {
  return {state_, prefix_ + name + "/"};
}

fs::path ResultsFolder::path() const {
  return prefix_.empty() ? state_->directory : state_->directory / fs::path(prefix_).parent_path();
}

}  // namespace rhexis::output
