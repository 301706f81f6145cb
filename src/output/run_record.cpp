// SPDX-License-Identifier: BSD-3-Clause
#include "output/run_record.hpp"

#include <fstream>
#include <utility>

#include "core/error.hpp"
#include "output/atomic_file.hpp"
#include "output/json.hpp"
#include "parallel/together.hpp"

namespace rhexis::output {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t spare_bytes = 1 << 16;  ///< more than most records take

std::string text_of(const Json& document) {
  // A reason may quote a file name in any encoding; it must not cost us the record.
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace

RunRecord::RunRecord(std::filesystem::path path, const Provenance& provenance, const Values& input,
                     const Values& results, const Values& performance, parallel::Communicator communicator)
    : path_(std::move(path)), communicator_(communicator) {
  document_ = std::make_unique<Json>(Json::object({{"version", provenance.version},
                                                   {"commit", provenance.commit},
                                                   {"command", provenance.command},
                                                   {"started", provenance.started},
                                                   {"file", provenance.file},
                                                   {"checkpoint", or_null(provenance.checkpoint)},
                                                   {"first_step", or_null(provenance.first_step)},
                                                   {"input", input},
                                                   {"warnings", Json::array()}}));
  parallel::on_root<RunError>(communicator_, [&] {
    (*document_)["status"] = nullptr;
    (*document_)["results"] = results;
    (*document_)["performance"] = performance;
    write(running_status);
    folder_.emplace(path_.parent_path());
  });
  if (!communicator_.is_root()) return;
  try {
    spare_ = std::make_unique<SpareSpace>(path_, spare_bytes);
  } catch (const RunError&) {  // what needs space first will say so
  }
}

RunRecord::~RunRecord() = default;

void RunRecord::warn(const std::string& text) {
  const std::lock_guard lock(mutex_);
  (*document_)["warnings"].push_back(text);
}

void RunRecord::know(const Values& results) {
  if (!communicator_.is_root()) return;
  const std::lock_guard lock(mutex_);
  (*document_)["results"] = results;
}

void RunRecord::complete(const Values& results, const Values& performance) {
  end("completed", results, performance);
}

void RunRecord::fail(const std::string& reason, const Values& results, const Values& performance) {
  end("failed: " + reason, results, performance);
}

void RunRecord::fail_alone(const std::string& reason) noexcept {
  try {
    const std::lock_guard lock(mutex_);
    const std::string on_disk = recorded_status(path_);
    const bool told_by_another =
        !on_disk.empty() && on_disk != running_status && on_disk != document_->value("status", "");
    if (ended_ || told_by_another) return;
    spare_.reset();
    write("failed: " + reason);
  } catch (const std::exception&) {  // the reason itself is about to be told
  }
}

void RunRecord::end(const std::string& status, const Values& results, const Values& performance) {
  parallel::on_root<RunError>(communicator_, [&] {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    spare_.reset();
    (*document_)["results"] = results;
    (*document_)["performance"] = performance;
    write(status);
  });
}

/// By the calling rank alone.
void RunRecord::write(const std::string& status) {
  if (folder_) folder_->require_unchanged();
  (*document_)["status"] = status;
  for (const char* part : {"results", "performance"})
    if (!document_->contains(part)) (*document_)[part] = nullptr;  // only the first rank has them
  write_atomically(path_, text_of(*document_));
}

std::string recorded_status(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return {};  // a pipe would keep us waiting
  std::ifstream file(path, std::ios::binary);
  const Json record = Json::parse(file, nullptr, /*allow_exceptions=*/false);
  if (!record.is_object() || !record.contains("status") || !record["status"].is_string()) return {};
  return record["status"];
}

}  // namespace rhexis::output
