#include "output/directory.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/text_file.hpp"
#include "output/numbered_picture.hpp"
#include "parallel/together.hpp"

namespace rhexis::output {
namespace {

namespace fs = std::filesystem;

/// Whether runs write files of this name into the folder itself. A restart's series is particles_from_<step>.
bool is_result(std::string name) {
  if (name.ends_with(".part")) name.resize(name.size() - 5);
  constexpr std::array fixed = {"run.json",       "history.csv", "particles.xdmf", "particles.h5",
                                "network.xdmf",   "network.h5",  "network.vtp",    "generations.csv",
                                "histograms.csv", "vessels.csv", "screening.csv",  "risk_histograms.csv",
                                "coupling.csv",   "cascade.csv", "samples.csv",    "probability.csv",
                                "movie.mp4"};
  return std::find(fixed.begin(), fixed.end(), name) != fixed.end() ||
         (name.starts_with("particles_from_") && (name.ends_with(".h5") || name.ends_with(".xdmf")));
}

/// Whole rows below the header of an ensemble's table.
bool holds_samples(const fs::path& directory) {
  if (!fs::exists(directory / "samples.csv")) return false;
  std::istringstream table(whole_file(directory / "samples.csv"));
  std::string line;
  return std::getline(table, line) && std::getline(table, line) && !table.eof();
}

[[noreturn]] void refuse(const fs::path& path, const std::string& reason) {
  throw InputError(fmt::format("cannot write results to {}: {}", path.string(), reason));
}

/// Folders made by this call, innermost last; taken back unless the call succeeds.
class NewDirectories {
 public:
  ~NewDirectories() {
    std::error_code ignored;
    for (auto path = made_.rbegin(); path != made_.rend(); ++path) fs::remove(*path, ignored);
  }

  /// Makes `path` with its parents where they are missing.
  void make(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (fs::is_directory(status)) return;
    if (fs::exists(status)) refuse(path, "it is a file, not a folder");
    if (path.has_parent_path() && path.parent_path() != path) make(path.parent_path());
    if (fs::create_directory(path, error)) made_.push_back(path);
    if (error) refuse(path, error.message());
  }

  void keep() { made_.clear(); }

 private:
  std::vector<fs::path> made_;
};

/// Only an attempt tells: permission bits say nothing about read-only file systems, quotas or the superuser.
void try_to_write_in(const fs::path& directory) {
  const fs::path probe = directory / ".rhexis-write-test";
  errno = 0;
  std::ofstream file(probe);
  file << "test" << std::flush;
  const std::string reason = file ? "" : std::strerror(errno);
  file.close();
  std::error_code ignored;
  fs::remove(probe, ignored);
  if (!reason.empty()) refuse(directory, reason);
}

/// Held as long as what is returned lives, or until this program ends, however it does. Where a file system
/// knows no locks, nothing is held.
std::shared_ptr<const void> lock(const fs::path& directory) {
  const int file = open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return nullptr;
  std::shared_ptr<const void> held(nullptr, [file](const void*) { close(file); });
  if (flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    refuse(directory, "another run is still writing there; wait for its end, or choose another folder");
  return held;
}

/// Removes the files in `directory` itself whose names `is_ours` accepts.
template <class Predicate>
void remove_files(const fs::path& directory, Predicate is_ours) {
  std::vector<fs::path> ours;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory)) {
    if (fs::is_regular_file(entry.symlink_status()) && is_ours(entry.path())) ours.push_back(entry.path());
  }
  for (const fs::path& path : ours) {
    std::error_code error;
    fs::remove(path, error);
    if (error) refuse(path, "cannot remove the results of an earlier run: " + error.message());
  }
}

/// What a run left in a folder of its own.
void remove_results(const fs::path& directory) {
  remove_files(directory, [](const fs::path& path) { return is_result(path.filename()); });
  if (fs::is_directory(directory / "images"))
    remove_files(directory / "images", [](const fs::path& path) { return !picture_series(path).empty(); });
}

/// The folders event_<digits> of a cascade go, unless somebody else has put something there.
void remove_events(const fs::path& directory) {
  std::vector<fs::path> events;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory)) {
    const std::string name = entry.path().filename();
    if (entry.is_directory() && name.starts_with("event_") && name.size() > 6 &&
        name.find_first_not_of("0123456789", 6) == std::string::npos) {
      events.push_back(entry.path());
    }
  }
  for (const fs::path& event : events) {
    remove_results(event);
    std::error_code not_empty;
    for (const fs::path& path : {event / "images", event / "checkpoints", event}) fs::remove(path, not_empty);
  }
}

}  // namespace

std::shared_ptr<const void> prepare_directory(const fs::path& directory, EarlierResults earlier,
                                              const parallel::Communicator& communicator) {
  std::shared_ptr<const void> held;
  parallel::on_root<InputError>(communicator, [&] {
    if (earlier == EarlierResults::remove && holds_samples(directory))
      refuse(directory,
             "it holds the samples of an ensemble; move samples.csv away, or choose another folder");
    NewDirectories created;
    created.make(directory);
    held = lock(directory);
    for (const fs::path& path : {directory, directory / "images", directory / "checkpoints"}) {
      created.make(path);
      try_to_write_in(path);
    }
    if (earlier == EarlierResults::remove) {
      remove_results(directory);
      remove_events(directory);
    }
    created.keep();
  });
  return held;
}

}  // namespace rhexis::output
