#include "output/directory.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <vector>

#include "core/error.hpp"
#include "output/together.hpp"

namespace rhexis::output {
namespace {

namespace fs = std::filesystem;

constexpr std::array result_files = {
    "run.json",  "history.csv",   "particles.xdmf",   "particles.h5",        "network.xdmf",     "network.h5",
    "movie.mp4", "run.json.part", "history.csv.part", "particles.xdmf.part", "network.xdmf.part"};

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

void remove_file(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(path))) return;
  fs::remove(path, error);
  if (error) refuse(path, "cannot remove the results of an earlier run: " + error.message());
}

void remove_results(const fs::path& directory) {
  for (const char* name : result_files) remove_file(directory / name);
  std::vector<fs::path> pictures;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory / "images")) {
    if (entry.path().extension() == ".png") pictures.push_back(entry.path());
  }
  for (const fs::path& picture : pictures) remove_file(picture);
}

}  // namespace

void prepare_directory(const fs::path& directory, EarlierResults earlier,
                       const parallel::Communicator& communicator) {
  on_root<InputError>(communicator, [&] {
    NewDirectories created;
    for (const fs::path& path : {directory, directory / "images", directory / "checkpoints"}) {
      created.make(path);
      try_to_write_in(path);
    }
    if (earlier == EarlierResults::remove) remove_results(directory);
    created.keep();
  });
}

}  // namespace rhexis::output
