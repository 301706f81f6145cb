// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/run_session.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/format.hpp"
#include "core/stopwatch.hpp"
#include "output/movie.hpp"
#include "output/temporary_file.hpp"
#include "parallel/link.hpp"
#include "parallel/together.hpp"
#include "runtime/terminal.hpp"
#include "runtime/version.hpp"

namespace rhexis::runtime {

RunSession::RunSession(RunDescription description, RunOptions options, parallel::Communicator comm,
                       RunState state)
    : description_(std::move(description)),
      options_(std::move(options)),
      comm_(comm),
      state_(std::move(state)),
      console_(comm.is_root(), options_.quiet),
      pictures_(options_.pictures ? options_.pictures : std::make_shared<Pictures>()),
      started_(options_.started) {}

void RunSession::open_folder(const output::FolderPlan& plan) {
  folder_ = options_.folder;
  if (!folder_) folder_.emplace(plan, comm_);
}

void RunSession::open_record(std::optional<std::int64_t> first_step) {
  output::Provenance provenance{
      .version = version(),
      .commit = commit(),
      .command = options_.command,
      .file = description_.file,
      .started = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                             fmt::gmtime(std::time(nullptr) - std::lround(seconds_now() - started_))),
      .first_step = first_step};
  if (!options_.restart.empty()) provenance.checkpoint = options_.restart.string();
  folder_->remove_earlier_results();
  signals_.emplace(folder_->path(), comm_.is_root(), options_.embedded);
  record_.emplace(folder_->claim("run.json"), provenance, *description_.input, state_.results(),
                  Performance{}, comm_);
  signals_->tell(*record_);
}

void RunSession::warn(const std::string& text) {
  console_.warning(text);
  if (record_) record_->warn(text);
}

Ending RunSession::recorded(const std::function<int()>& work) {
  int signal = 0;
  try {
    signal = work();
  } catch (const InputError& error) {
    if (!record_) throw;
    note_failure(error.what());
    throw RunError(error.what());
  } catch (const RunError& error) {
    note_failure(error.what());
    throw;
  } catch (const std::exception& error) {  // of this rank alone
    if (record_) record_->fail_alone(reason_of(error));
    throw;
  }
  if (comm_.is_root() && !output_failure().empty()) {
    warn(fmt::format("stdout could not be written ({}): what the run said there is lost, its results are not",
                     output_failure()));
  }
  if (signal != 0) {
    record_->fail(interrupted_by(signal), state_.results(), performance());
  } else {
    record_->complete(state_.results(), performance());
  }
  return {signal};
}

/// A disk that is full for this too must not hide the reason.
void RunSession::note_failure(const std::string& reason) {
  if (!record_) return;
  try {
    record_->fail(reason, state_.results(), performance());
  } catch (const RunError& also) {
    console_.warning(also.what());
  }
}

void RunSession::start_pictures() {
  const Stopwatch watch(spent_.insitu);
  if (!options_.pictures)
    *pictures_ = runtime::start_pictures(description_.pictures, *folder_, comm_, fail_records_alone);
}

void RunSession::finish_pictures() {
  if (!pictures_->pipeline || options_.pictures) return;
  const Stopwatch watch(spent_.insitu);
  pictures_->pipeline->finish();
}

void RunSession::make_movie() {
  if (!pictures_->pipeline || options_.pictures || !description_.movie) return;
  const Stopwatch watch(spent_.insitu);
  std::string problem;
  parallel::together(comm_, [&] {
    if (!comm_.is_root()) return;
    output::TemporaryFile movie(folder_->path() / "movie.mp4");
    problem = output::make_movie(folder_->path() / "images", folder_->files_in("images"), movie.name(),
                                 description_.frames_per_second);
    if (!problem.empty()) return;
    folder_->claim_on_root("movie.mp4");
    movie.put_in_place();
  });
  if (!problem.empty()) warn("no movie: " + problem);
}

Performance RunSession::performance() {
  Performance p;
  const Work work = state_.work();
  if (const std::string name = output::processor_name(); !name.empty()) p.processor = name;
  p.compiler = compiler();
  p.ranks = comm_.size();
  p.threads = parallel::thread_count();
  p.wall_s = seconds_now() - started_;
  p.solve_s = spent_.solve;
  p.insitu_s = spent_.insitu;
  p.output_s = spent_.output;
  if (const auto& own = work.bond_evaluations) {
    p.bond_evaluations = comm_.all_reduce(*own, parallel::Reduce::sum);
    if (spent_.solve > 0) p.bond_evaluations_per_s = static_cast<double>(*p.bond_evaluations) / spent_.solve;
    p.flop = static_cast<double>(*p.bond_evaluations) * work.flop_per_evaluation;
  }
  if (const auto& flop = work.network_flop) p.flop = p.flop.value_or(0) + *flop;
  if (const auto& own = work.traffic) {
    p.exchange_s = comm_.all_reduce(own->seconds, parallel::Reduce::sum) / comm_.size();
    p.exchange_bytes = comm_.all_reduce(own->bytes, parallel::Reduce::sum);
  }
  if (const auto link = parallel::measure_link(comm_)) {
    p.message_latency_s = link->latency_s;
    p.message_bandwidth_B_s = link->bandwidth_B_s;
  }
  p.peak_rss_bytes = comm_.all_reduce(output::peak_resident_bytes(), parallel::Reduce::sum);
  p.node_hours = *p.wall_s * comm_.node_count() / 3600;
  p.energy_J = energy_of_nodes();
  return p;
}

/// The energy that all nodes have used, J; none where one of them does not tell. Collective.
std::optional<double> RunSession::energy_of_nodes() {
  const bool leads = comm_.leads_node();
  const std::optional<double> here = energy_.read();
  if (comm_.all_reduce(std::int64_t{leads && !here}, parallel::Reduce::sum) > 0) return {};
  return comm_.all_reduce(leads ? *here : 0.0, parallel::Reduce::sum);
}

void print_title(Console& console, const std::string& title, const std::string& file) {
  console.line(fmt::format("Rhexis {} ({}): {}", version(), commit(), title.empty() ? file : title));
  console.item("input", file);
}

void RunSession::warn(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) warn(text);
}

void RunSession::print_surroundings() {
  console_.item("parallel", fmt::format("{} rank{} x {} thread{}", comm_.size(), comm_.size() > 1 ? "s" : "",
                                        parallel::thread_count(), parallel::thread_count() > 1 ? "s" : ""));
  if (!pictures_->description.empty()) console_.item("pictures", pictures_->description);
  console_.item("results", options_.directory.string());
}

void RunSession::print_cost(const Performance& p) {
  console_.item("time spent",
                fmt::format("{} in all: {} solving, {} pictures, {} output", duration(*p.wall_s),
                            duration(*p.solve_s), duration(*p.insitu_s), duration(*p.output_s)));
  console_.item("memory",
                fmt::format("{:.0f} MB over all ranks", static_cast<double>(*p.peak_rss_bytes) / 1e6));
  console_.item("results", options_.directory.string());
}

}  // namespace rhexis::runtime
