// SPDX-License-Identifier: BSD-3-Clause
#include "output/staging_folder.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "output/temporary_file.hpp"
#include "parallel/together.hpp"

namespace rhexis::output {
namespace {

namespace fs = std::filesystem;

/// A file without a number in its name may be written again at a later step, so it needs content of its own.
bool is_numbered(const fs::path& file) {
  return file.stem().string().find_first_of("0123456789") != std::string::npos;
}

/// Gives `target` the content of `source`, in one step and, where possible, without copying it.
void publish(const fs::path& source, const fs::path& target) {
  const fs::path linked = temporary_name_beside(target);
  if (is_numbered(source) && link(source.c_str(), linked.c_str()) == 0) {
    std::error_code error;
    fs::rename(linked, target, error);
    unlink(linked.c_str());  // it stays where both names had been the same file's
    if (error) throw RunError(fmt::format("{}: cannot write the file: {}", target.string(), error.message()));
    return;
  }
  TemporaryFile copy(target);
  std::error_code error;
  fs::copy_file(source, copy.name(), fs::copy_options::overwrite_existing, error);
  if (error) throw RunError(fmt::format("{}: cannot write the file: {}", target.string(), error.message()));
  copy.put_in_place();
}

}  // namespace

StagingFolder::StagingFolder(ResultsFolder results, std::string place,
                             const parallel::Communicator& communicator)
    : results_(std::move(results)), place_(std::move(place)), communicator_(communicator) {
  path_ = communicator_.broadcast(
      fs::absolute(temporary_name_beside(results_.path() / place_ / "staging")).string());
}

StagingFolder::~StagingFolder() {
  std::error_code ignored;
  if (open_ && communicator_.is_root()) fs::remove_all(path_, ignored);
}

StagingFolder::Version StagingFolder::version_of(const fs::path& file) {
  struct stat status {};
  if (lstat(file.c_str(), &status) != 0) return {};
  return {static_cast<std::int64_t>(status.st_ino), status.st_size, status.st_mtim.tv_sec,
          status.st_mtim.tv_nsec};
}

void StagingFolder::open() {
  if (std::exchange(open_, true)) return;
  parallel::on_root<RunError>(communicator_, [&] {
    if (mkdir(path_.c_str(), 0777) != 0)
      throw RunError(fmt::format("{}: cannot make the folder: {}", path_.string(), std::strerror(errno)));
    for (const std::string& name : results_.files_in(place_)) {
      const fs::path earlier = results_.path() / place_ / name, staged = path_ / name;
      if (!fs::is_regular_file(fs::symlink_status(earlier))) continue;
      fs::create_directories(staged.parent_path());
      publish(earlier, staged);
      delivered_[name] = {version_of(staged)};
    }
  });
}

void StagingFolder::deliver(const std::string& author, long step) {
  if (!open_) return;
  parallel::on_root<RunError>(communicator_, [&] {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path_)) {
      if (fs::is_regular_file(entry.symlink_status()))
        deliver_file(entry.path().lexically_relative(path_).string(), author, step);
    }
  });
}

void StagingFolder::deliver_file(const std::string& name, const std::string& author, long step) {
  const Version version = version_of(path_ / name);
  const auto earlier = delivered_.find(name);
  if (earlier != delivered_.end() && earlier->second.version == version) return;
  if (earlier != delivered_.end() && earlier->second.step == step && earlier->second.author != author) {
    throw RunError(fmt::format("{} and {} both write {}/{} at step {}; give one of the files another name",
                               earlier->second.author, author, place_, name, step));
  }
  try {
    publish(path_ / name, results_.claim_on_root(place_ + "/" + name));
  } catch (const InputError& in_the_way) {
    throw RunError(fmt::format("{}: {}", author, in_the_way.what()));
  }
  delivered_[name] = {version, author, step};
}

}  // namespace rhexis::output
