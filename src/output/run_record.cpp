#include "output/run_record.hpp"

#include <fstream>
#include <utility>

#include "core/error.hpp"
#include "output/atomic_file.hpp"
#include "parallel/together.hpp"

namespace rhexis::output {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t spare_bytes = 1 << 16;  ///< more than most records take

std::string text_of(const Json& document) {
  // A reason may quote a file name in any encoding; it must not cost us the record.
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

}  // namespace

void to_json(Json& json, const NetworkResults& network) {
  json = Json::object({{"vessels", or_null(network.vessels)},
                       {"junctions", or_null(network.junctions)},
                       {"inflow_m3_s", or_null(network.inflow_m3_s)},
                       {"max_imbalance", or_null(network.max_imbalance)},
                       {"volume_m3", or_null(network.volume_m3)},
                       {"surface_m2", or_null(network.surface_m2)},
                       {"highest_reynolds", or_null(network.highest_reynolds)},
                       {"highest_pressure_Pa", or_null(network.highest_pressure_Pa)},
                       {"lowest_pressure_Pa", or_null(network.lowest_pressure_Pa)},
                       {"solver", or_null(network.solver)},
                       {"iterations", or_null(network.iterations)},
                       {"queries", network.queries},
                       {"screening", network.screening}});
}

void to_json(Json& json, const Results& results) {
  json = Json::object({{"particles", or_null(results.particles)},
                       {"bonds", or_null(results.bonds)},
                       {"family_max", or_null(results.family_max)},
                       {"time_step_s", or_null(results.time_step_s)},
                       {"stable_time_step_s", or_null(results.stable_time_step_s)},
                       {"steps", or_null(results.steps)},
                       {"simulated_s", or_null(results.simulated_s)},
                       {"first_bond_break_s", or_null(results.first_bond_break_s)},
                       {"rupture_onset_s", or_null(results.rupture_onset_s)},
                       {"pressure_at_onset_Pa", or_null(results.pressure_at_onset_Pa)},
                       {"blood_pressure_at_onset_Pa", or_null(results.blood_pressure_at_onset_Pa)},
                       {"max_displacement_at_onset_m", or_null(results.max_displacement_at_onset_m)},
                       {"max_displacement_m", or_null(results.max_displacement_m)},
                       {"max_damage", or_null(results.max_damage)},
                       {"rupture_length_m", or_null(results.rupture_length_m)},
                       {"opening_area_m2", or_null(results.opening_area_m2)},
                       {"energy_drift", or_null(results.energy_drift)},
                       {"network", results.network},
                       {"coupling", results.coupling},
                       {"cascade", results.cascade},
                       {"ensemble", results.ensemble}});
}

void to_json(Json& json, const Performance& performance) {
  json = Json::object({{"processor", or_null(performance.processor)},
                       {"compiler", or_null(performance.compiler)},
                       {"ranks", or_null(performance.ranks)},
                       {"threads", or_null(performance.threads)},
                       {"wall_s", or_null(performance.wall_s)},
                       {"solve_s", or_null(performance.solve_s)},
                       {"insitu_s", or_null(performance.insitu_s)},
                       {"output_s", or_null(performance.output_s)},
                       {"bond_evaluations", or_null(performance.bond_evaluations)},
                       {"bond_evaluations_per_s", or_null(performance.bond_evaluations_per_s)},
                       {"flop", or_null(performance.flop)},
                       {"exchange_s", or_null(performance.exchange_s)},
                       {"exchange_bytes", or_null(performance.exchange_bytes)},
                       {"message_latency_s", or_null(performance.message_latency_s)},
                       {"message_bandwidth_B_s", or_null(performance.message_bandwidth_B_s)},
                       {"peak_rss_bytes", or_null(performance.peak_rss_bytes)},
                       {"node_hours", or_null(performance.node_hours)},
                       {"energy_J", or_null(performance.energy_J)}});
}

RunRecord::RunRecord(std::filesystem::path path, const Provenance& provenance,
                     parallel::Communicator communicator)
    : path_(std::move(path)), communicator_(communicator) {
  document_ = Json::object({{"version", provenance.version},
                            {"commit", provenance.commit},
                            {"command", provenance.command},
                            {"started", provenance.started},
                            {"file", provenance.file},
                            {"checkpoint", or_null(provenance.checkpoint)},
                            {"first_step", or_null(provenance.first_step)},
                            {"input", provenance.input},
                            {"warnings", Json::array()}});
  parallel::on_root<RunError>(communicator_, [&] {
    document_["status"] = nullptr;
    document_["results"] = Results{};
    document_["performance"] = Performance{};
    write(running_status);
    folder_.emplace(path_.parent_path());
  });
  if (!communicator_.is_root()) return;
  try {
    spare_ = std::make_unique<SpareSpace>(path_, spare_bytes);
  } catch (const RunError&) {  // what needs space first will say so
  }
}

void RunRecord::warn(const std::string& text) {
  const std::lock_guard lock(mutex_);
  document_["warnings"].push_back(text);
}

void RunRecord::know(const Results& results) {
  if (!communicator_.is_root()) return;
  const std::lock_guard lock(mutex_);
  document_["results"] = results;
}

void RunRecord::complete(const Results& results, const Performance& performance) {
  end("completed", results, performance);
}

void RunRecord::fail(const std::string& reason, const Results& results, const Performance& performance) {
  end("failed: " + reason, results, performance);
}

void RunRecord::fail_alone(const std::string& reason) noexcept {
  try {
    const std::lock_guard lock(mutex_);
    const std::string on_disk = recorded_status(path_);
    const bool told_by_another =
        !on_disk.empty() && on_disk != running_status && on_disk != document_.value("status", "");
    if (ended_ || told_by_another) return;
    spare_.reset();
    write("failed: " + reason);
  } catch (const std::exception&) {  // the reason itself is about to be told
  }
}

void RunRecord::end(const std::string& status, const Results& results, const Performance& performance) {
  parallel::on_root<RunError>(communicator_, [&] {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    spare_.reset();
    document_["results"] = results;
    document_["performance"] = performance;
    write(status);
  });
}

/// By the calling rank alone.
void RunRecord::write(const std::string& status) {
  if (folder_) folder_->require_unchanged();
  document_["status"] = status;
  for (const char* part : {"results", "performance"})
    if (!document_.contains(part)) document_[part] = nullptr;  // only the first rank has them
  write_atomically(path_, text_of(document_));
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
