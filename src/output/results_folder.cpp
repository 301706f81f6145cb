#include "output/results_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <climits>
#include <cstring>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "core/error.hpp"
#include "core/text_file.hpp"
#include "output/atomic_file.hpp"
#include "output/manifest.hpp"
#include "output/temporary_file.hpp"
#include "parallel/together.hpp"

namespace rhexis::output {
namespace {

namespace fs = std::filesystem;

constexpr std::array standing_folders = {"images", "checkpoints"};

/// Room for what is written into a results folder, in bytes of a path: pictures in a folder of their own, and
/// temporary names.
constexpr std::size_t longest_name_inside = 512;

[[noreturn]] void refuse(const fs::path& path, const std::string& reason,
                         const std::string& remedy = "choose another folder with -o") {
  throw InputError(fmt::format("cannot write results to {}: {}; {}", path.string(), reason, remedy));
}

/// Whether there is a folder of this name. Throws where something else has it.
bool is_folder(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) return true;
  if (fs::exists(status)) refuse(path, "it is a file, not a folder");
  if (fs::is_symlink(fs::symlink_status(path, error))) refuse(path, "it is a link that leads nowhere");
  return false;
}

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
    if (error) refuse(path, error.message());
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
  if (file < 0) refuse(directory, std::strerror(errno));
  const bool written = write(file, "test", 4) == 4;
  const std::string reason = std::strerror(errno);
  close(file);
  unlink(probe.c_str());
  if (!written) refuse(directory, reason);
}

/// Held as long as what is returned lives, or until this program ends, however it does.
std::shared_ptr<const void> lock(const fs::path& directory) {
  const int file = open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return nullptr;
  std::shared_ptr<const void> held(nullptr, [file](const void*) { close(file); });
  if (flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    refuse(directory, "another run is still writing there",
           "wait for its end, or choose another folder with -o");
  return held;
}

constexpr const char* samples = "samples.csv";

/// Whole rows below the header of an ensemble's table.
bool holds_samples(const fs::path& directory) {
  if (!fs::is_regular_file(directory / samples)) return false;
  std::istringstream table(whole_file(directory / samples));
  std::string line;
  return std::getline(table, line) && std::getline(table, line) && !table.eof();
}

/// Which file it is, whatever its name.
using Identity = std::pair<dev_t, ino_t>;

std::optional<Identity> identity(const fs::path& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return {};
  return Identity(status.st_dev, status.st_ino);
}

std::set<Identity> identities(const std::vector<fs::path>& paths) {
  std::set<Identity> all;
  const auto add = [&](const fs::path& path) {
    if (const auto file = identity(path)) all.insert(*file);
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

std::string list_of(const std::vector<std::string>& names) {
  constexpr std::size_t shown = 5;
  const std::vector<std::string> first(
      names.begin(), names.begin() + static_cast<std::ptrdiff_t>(std::min(shown, names.size())));
  return fmt::format("{}{}", fmt::join(first, ", "),
                     names.size() > shown ? fmt::format(" and {} more", names.size() - shown) : "");
}

/// Names of what is in a folder; none where it is not there.
std::vector<std::string> entries_of(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
    names.push_back(entry.path().filename().string());
  return names;
}

/// What the root knows of the folder before it changes anything.
class Contents {
 public:
  explicit Contents(const FolderPlan& plan)
      : directory_(plan.directory), overwrite_(plan.overwrite), reads_(identities(plan.reads)) {
    for (fs::path path = directory_; !is_folder(path) && path.has_parent_path(); path = path.parent_path()) {
    }
    const bool for_samples = std::ranges::find(plan.writes.names, samples) != plan.writes.names.end();
    if (plan.earlier == EarlierResults::remove && !for_samples && holds_samples(directory_)) {
      refuse(directory_, "it holds the samples of an ensemble",
             "move samples.csv away, or choose another folder with -o");
    }
    try {
      manifest = read_manifest(directory_);
    } catch (const InputError& error) {
      if (!overwrite_)
        refuse(directory_, error.what(),
               "move that file away, replace it with --overwrite, or choose another folder with -o");
    }
    for (const char* folder : standing_folders) refuse_detour(std::string(folder) + "/x");
    refuse_obstacles(std::vector<std::string>{Manifest::file_name});
    refuse_obstacles(plan.writes);
  }

  void refuse_obstacles(const FutureFiles& files) const {
    std::vector<std::string> names = files.names;
    for (const std::string folder : standing_folders) {
      for (const std::string& entry : entries_of(directory_ / folder)) {
        if (const std::string name = folder + "/" + entry; files.may_be_written(name)) names.push_back(name);
      }
    }
    refuse_obstacles(names);
  }

  /// Throws if one of these files cannot be written.
  void refuse_obstacles(const std::vector<std::string>& names) const {
    std::vector<std::string> read, foreign;
    for (const std::string& name : names) {
      refuse_detour(name);
      struct stat status {};
      const fs::path path = directory_ / name;
      if (lstat(path.c_str(), &status) != 0) {
        if (errno != ENOENT) refuse(path, std::strerror(errno));
        continue;
      }
      if (S_ISDIR(status.st_mode)) refuse(path, "it is a folder, and the run writes a file of this name");
      if (is_read(path)) read.push_back(name);
      if (!is_ours(name) && !overwrite_) foreign.push_back(name);
    }
    if (!read.empty())
      refuse(directory_, fmt::format("the run reads {} and would replace {}", list_of(read),
                                     read.size() > 1 ? "them" : "it"));
    if (!foreign.empty()) {
      refuse(directory_,
             fmt::format("{} would be replaced, and no earlier run made {}", list_of(foreign),
                         foreign.size() > 1 ? "them" : "it"),
             fmt::format("move {0} away, replace {0} with --overwrite, or choose another folder with -o",
                         foreign.size() > 1 ? "them" : "it"));
    }
  }

  bool is_read(const fs::path& path) const {
    const auto file = identity(path);
    return file && reads_.contains(*file);
  }

  /// Whether all folders on the way to this file are folders, not links, as far as they are there.
  bool is_straight(const std::string& name) const { return detour(name).empty(); }

  Manifest manifest;

 private:
  bool is_ours(const std::string& name) const {
    return manifest.files.contains(name) || name == Manifest::file_name;
  }

  /// The first part of the way to a file that is no folder.
  fs::path detour(const std::string& name) const {
    for (std::size_t slash = name.find('/'); slash != std::string::npos; slash = name.find('/', slash + 1)) {
      const fs::path folder = directory_ / name.substr(0, slash);
      struct stat status {};
      if (lstat(folder.c_str(), &status) == 0 && !S_ISDIR(status.st_mode)) return folder;
    }
    return {};
  }

  void refuse_detour(const std::string& name) const {
    const fs::path folder = detour(name);
    if (folder.empty()) return;
    refuse(folder, fs::is_symlink(folder) ? "it is a link, and links inside a results folder are not followed"
                                          : "it is a file, not a folder");
  }

  fs::path directory_;
  bool overwrite_;
  std::set<Identity> reads_;
};

bool stays(const std::string& name) {
  return name.starts_with("checkpoints/") || name.find("/checkpoints/") != std::string::npos;
}

}  // namespace

/// Shared by the handles. All but `directory` is the root's.
class ResultsFolder::State {
 public:
  State(const FolderPlan& plan, const parallel::Communicator& communicator)
      : directory(plan.directory), comm(communicator), earlier_(plan.earlier) {
    share_run_token(comm.broadcast(run_token()));
    parallel::on_root<InputError>(comm, [&] {
      if (fs::absolute(directory).string().size() + longest_name_inside > PATH_MAX)
        refuse(directory, std::strerror(ENAMETOOLONG));
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
    if (earlier_ == EarlierResults::remove) remove_files();
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
      refuse(path, fmt::format("cannot remove the results of an earlier run: {}", std::strerror(errno)));
  }

  /// Removes the temporary files of earlier runs.
  void remove_unfinished() const {
    const Manifest& manifest = contents_->manifest;
    if (manifest.tokens.empty()) return;
    std::set<std::string> folders(standing_folders.begin(), standing_folders.end());
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

  /// Removes the files of the manifest but checkpoints, then the folders that have become empty.
  void remove_files() {
    Manifest& manifest = contents_->manifest;
    std::erase_if(manifest.files, [&](const std::string& name) {
      const fs::path path = directory / name;
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

  EarlierResults earlier_;
  NewFolders made_;
  std::shared_ptr<const void> lock_;
  std::optional<Contents> contents_;
  TableFile list_;
  std::set<std::string> claimed_;
  bool begun_ = false;
};

void refuse_obstacles(const FolderPlan& plan, const parallel::Communicator& communicator) {
  parallel::on_root<InputError>(communicator, [&] { const Contents unobstructed(plan); });
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
