// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/ensemble/ensemble_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/error.hpp"
#include "core/format.hpp"
#include "core/stopwatch.hpp"
#include "core/text_file.hpp"
#include "input/difference.hpp"
#include "output/atomic_file.hpp"
#include "parallel/exchange.hpp"
#include "parallel/together.hpp"
#include "peridynamics/engine/bond_kernel.hpp"
#include "runtime/interrupt.hpp"
#include "scenes/folder_plan.hpp"
#include "scenes/pictures.hpp"
#include "studies/ensemble/sample_table.hpp"

namespace rhexis::scenes {
namespace {

using ensemble::Sample;
using Json = nlohmann::ordered_json;

/// Time between gatherings that is aimed at, s: what a crash may cost, against ranks that wait for others.
constexpr double round_s = 5;

/// Keys that do not change a sample: a folder may hold what several of their values asked for.
bool only_chooses_samples(const std::string& key) {
  constexpr std::array free = {"scene.title",
                               "ensemble.pressures",
                               "ensemble.lowest_pressure",
                               "ensemble.highest_pressure",
                               "ensemble.pressure_count",
                               "ensemble.samples"};
  return std::find(free.begin(), free.end(), key) != free.end();
}

std::string table_of(const std::vector<Sample>& samples) {
  std::string text = ensemble::sample_header;
  for (const Sample& s : samples) text += ensemble::row(s);
  return text;
}

}  // namespace

EnsembleRun::EnsembleRun(Configuration configuration, runtime::RunOptions options,
                         parallel::Communicator comm)
    : c_(std::move(configuration)),
      comm_(comm),
      session_(scene_of(c_), std::move(options), comm,
               {[this] { return output::Values(results_); },
                [this] {
                  return runtime::Work{.bond_evaluations = bond_evaluations_,
                                       .flop_per_evaluation = 0.5 * peridynamics::flop_per_bond};
                }}) {
  if (!session_.options().restart.empty()) {
    throw InputError(
        "--restart is for scenes with one wall after the other; an ensemble goes on where it stopped when "
        "the "
        "same command is given again");
  }
}

runtime::Ending EnsembleRun::run() {
  read_earlier();
  output::FolderPlan folder = folder_plan(c_, session_.options());
  if (earlier_ > 0) folder.earlier = output::EarlierResults::keep;
  session_.open_folder(std::move(folder));
  plan();
  const runtime::Ending ending = session_.recorded([&] {
    open_results();
    print_header();
    run_samples();
    finish();
    return signal_;
  });
  print_summary();
  return ending;
}

/// The samples that an earlier run left in the folder.
void EnsembleRun::read_earlier() {
  const std::filesystem::path path = session_.options().directory / "samples.csv",
                              record = session_.options().directory / "run.json";
  std::string text;
  parallel::on_root<InputError>(comm_, [&] {
    if (!std::filesystem::exists(path)) return;
    text = whole_file(path);
    if (ensemble::read_samples(text, path.string()).empty()) return;
    const Json earlier = Json::parse(whole_file(record), nullptr, false);
    std::string differs = record.string() + " does not tell of which";
    if (earlier.is_object() && earlier.contains("input") && input::is_record(earlier["input"])) {
      const auto differences = input::differences(
          earlier["input"], c_.record, [](const std::string& key) { return !only_chooses_samples(key); });
      if (differences.empty()) return;
      differs = differences.front().text;
    }
    throw InputError(fmt::format(
        "{} holds samples of another ensemble ({}); choose another folder with -o, or remove that file",
        path.string(), differs));
  });
  samples_ = ensemble::read_samples(comm_.broadcast(text), path.string());
  earlier_ = samples_.size();
}

void EnsembleRun::plan() {
  std::set<Task> done;
  for (const Sample& s : samples_) done.emplace(s.wall, s.pressure);
  // Wall by wall, so that the pressures' curves grow together.
  for (std::int64_t wall = 0; wall < c_.ensemble.samples; ++wall) {
    for (const double pressure : c_.ensemble.pressures) {
      if (!done.contains({wall, pressure})) tasks_.emplace_back(wall, pressure);
    }
  }
}

void EnsembleRun::open_results() {
  session_.open_record();
  const std::filesystem::path path = session_.folder().claim("samples.csv");
  parallel::on_root<RunError>(comm_, [&] { table_ = output::TableFile(path, table_of(samples_)); });
}

void EnsembleRun::print_header() {
  const peridynamics::Parameters& v = c_.wall->parameters;
  const ensemble::Parameters& e = c_.ensemble;
  session_.print_title();
  session_.warn(c_.warnings);
  session_.console().item("vessel",
                          fmt::format("lumen radius {}, outer radius {}, length {}; ends {}; spacing {}",
                                      quantity(v.inner_radius, "m"), quantity(v.outer_radius, "m"),
                                      quantity(v.length, "m"), name_of(v.ends), quantity(*v.spacing, "m")));
  session_.console().item("pressures", fmt::format("{} from {} to {} ({}), up to {}", e.pressures.size(),
                                                   mmhg(e.pressures.front()), mmhg(e.pressures.back()),
                                                   name_of(v.schedule), quantity(v.end_time, "s")));
  session_.console().item(
      "walls",
      fmt::format("{} (seed {}); spreads: strength {}, thickness {}, stiffness {}", e.samples, e.seed,
                  text(e.strength_spread), text(e.thickness_spread), text(e.stiffness_spread)));
  const auto done = e.vessels() - static_cast<long long>(tasks_.size());
  const auto others = static_cast<long long>(earlier_) - done;
  session_.console().item(
      "samples",
      fmt::format("{}, {} of them done before{}", grouped(e.vessels()), grouped(done),
                  others > 0 ? fmt::format("; {} others in samples.csv count too", grouped(others)) : ""));
  session_.print_surroundings();
}

void EnsembleRun::run_samples() {
  const runtime::InterruptGuard guard;
  const auto ranks = static_cast<std::size_t>(comm_.size());
  const auto total = static_cast<long>(c_.ensemble.vessels());
  const auto progress = [&](std::size_t next) {
    const auto ruptured =
        std::count_if(samples_.begin(), samples_.end(), [](const Sample& s) { return s.ruptured; });
    session_.console().progress(total - static_cast<long>(tasks_.size() - next), total,
                                fmt::format("{} ruptured", grouped(ruptured)), "sample");
  };
  progress(0);
  std::size_t each = 1;  // samples of a rank in a round
  for (std::size_t next = 0; next < tasks_.size() && signal_ == 0;) {
    const std::size_t count = std::min(each * ranks, tasks_.size() - next);
    const double start = seconds_now();
    signal_ = run_round(next, count);
    const double per_sample =
        comm_.all_reduce((seconds_now() - start) / static_cast<double>(each), parallel::Reduce::max);
    each = static_cast<std::size_t>(std::clamp(round_s / per_sample, 1.0, 1000.0));
    next += count;
    if (signal_ == 0) progress(next);
  }
}

/// Does tasks [first, first + count) and keeps what has come of them. The signal that ended it, or 0.
int EnsembleRun::run_round(std::size_t first, std::size_t count) {
  const auto ranks = static_cast<std::size_t>(comm_.size()), rank = static_cast<std::size_t>(comm_.rank());
  std::vector<Sample> finished;
  std::string failure;
  {
    const Stopwatch watch(session_.spent().solve);
    std::vector<Sample> own;
    try {
      const Stopwatch alone(sample_s_);
      for (std::size_t turn = 0; turn * ranks < count; ++turn) {
        // To and fro, for higher pressures take less time.
        const std::size_t i = turn * ranks + (turn % 2 == 0 ? rank : ranks - 1 - rank);
        if (i >= count) continue;
        const auto& [wall, pressure] = tasks_[first + i];
        const auto sample = ensemble::simulate(c_.ensemble, *c_.wall, pressure, wall,
                                               runtime::InterruptGuard::requested, bond_evaluations_);
        if (!sample) break;
        own.push_back(*sample);
      }
    } catch (const std::exception& error) {
      failure = error.what();
    }
    finished = parallel::all_gather(comm_, own).records;
    std::sort(finished.begin(), finished.end(), ensemble::comes_before);
  }
  keep(finished);
  failure = comm_.first_non_empty(failure);
  if (!failure.empty()) throw RunError(failure);
  const auto signal =
      comm_.all_reduce(std::int64_t{runtime::InterruptGuard::requested()}, parallel::Reduce::max);
  return samples_.size() - earlier_ < tasks_.size() ? static_cast<int>(signal) : 0;
}

void EnsembleRun::keep(const std::vector<Sample>& finished) {
  const Stopwatch watch(session_.spent().output);
  samples_.insert(samples_.end(), finished.begin(), finished.end());
  parallel::on_root<RunError>(comm_, [&] {
    std::string rows;
    for (const Sample& s : finished) rows += ensemble::row(s);
    table_.append(rows);
  });
}

/// Puts all samples in order, whatever runs they come from, and counts.
void EnsembleRun::finish() {
  const std::size_t now = samples_.size() - earlier_;
  std::sort(samples_.begin(), samples_.end(), ensemble::comes_before);
  probabilities_ = ensemble::probabilities(samples_);
  {
    const Stopwatch watch(session_.spent().output);
    const std::filesystem::path samples = session_.folder().claim("samples.csv"),
                                probability = session_.folder().claim("probability.csv");
    parallel::on_root<RunError>(comm_, [&] {
      output::write_atomically(samples, table_of(samples_));
      output::write_atomically(probability, ensemble::probability_table(probabilities_));
    });
  }
  const double sample_s = comm_.all_reduce(sample_s_, parallel::Reduce::sum);
  std::int64_t steps = 0, ruptured = 0;
  for (const Sample& s : samples_) {
    steps += s.steps;
    ruptured += s.ruptured ? 1 : 0;
  }
  results_.ensemble = {{"pressures", probabilities_.size()},
                       {"samples", samples_.size()},
                       {"samples_of_earlier_runs", earlier_},
                       {"ruptured", ruptured},
                       {"steps", steps},
                       {"rank_seconds_per_sample", nullptr},
                       {"samples_left", static_cast<std::int64_t>(tasks_.size() - now)}};
  if (now > 0) results_.ensemble["rank_seconds_per_sample"] = sample_s / static_cast<double>(now);
}

void EnsembleRun::print_summary() {
  if (signal_ != 0) {
    session_.console().important(
        fmt::format("Interrupted by {}; finished samples are saved. The same command goes on.",
                    runtime::signal_name(signal_)));
  } else {
    session_.console().line("Done.");
  }
  session_.console().line("    pressure    samples  ruptured  probability   95 % interval   mean onset");
  for (const ensemble::Probability& p : probabilities_) {
    const auto [low, high] = p.interval();
    session_.console().line(fmt::format("  {:>12}  {:>7}  {:>8}  {:>11.3f}  {:.3f} to {:.3f}  {:>11}",
                                        mmhg(p.pressure), p.samples, p.ruptured, p.value(), low, high,
                                        p.mean_onset ? quantity(*p.mean_onset, "s", 3) : "none"));
  }
  const Json& each = results_.ensemble["rank_seconds_per_sample"];
  session_.console().item(
      "samples", fmt::format("{} in all, {} new; {}", grouped(static_cast<long long>(samples_.size())),
                             grouped(static_cast<long long>(samples_.size() - earlier_)),
                             each.is_null() ? "none simulated"
                                            : quantity(each.get<double>(), "s", 3) + " each on one rank"));
  session_.print_cost(session_.performance());
}

}  // namespace rhexis::scenes
