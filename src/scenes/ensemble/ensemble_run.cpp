// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/ensemble/ensemble_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>
#include <vector>

#include "core/format.hpp"
#include "core/stopwatch.hpp"
#include "core/text_file.hpp"
#include "input/difference.hpp"
#include "output/atomic_file.hpp"
#include "output/json.hpp"
#include "parallel/together.hpp"
#include "peridynamics/engine/bond_kernel.hpp"
#include "runtime/interrupt.hpp"
#include "runtime/run_session.hpp"
#include "scenes/results.hpp"
#include "studies/ensemble/probability.hpp"
#include "studies/ensemble/round.hpp"
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

long long count_ruptured(const std::vector<Sample>& samples) {
  return std::ranges::count_if(samples, [](const Sample& s) { return s.ruptured; });
}

class EnsembleRun {
 public:
  EnsembleRun(EnsembleScene scene, const runtime::RunOptions& options, parallel::Communicator comm)
      : scene_(std::move(scene)),
        comm_(comm),
        session_(describe(scene_, {}, {}), options, comm,
                 {[this] { return output::Values(results_); },
                  [this] {
                    return runtime::Work{
                        .bond_evaluations = bond_evaluations_,
                        .flop_per_evaluation = peridynamics::flop_per_evaluation(*scene_.wall)};
                  }}) {
    if (session_.restarts())
      throw InputError(
          "--restart is for scenes with one wall after the other; an ensemble goes on where it stopped when "
          "the same command is given again");
  }

  runtime::Ending run() {
    read_earlier();
    output::FolderPlan folder = folder_plan(scene_, session_.options());
    if (earlier_ > 0) folder.earlier = output::EarlierResults::keep;
    session_.open_folder(std::move(folder));
    tasks_ = ensemble::tasks_left(scene_.ensemble, samples_);
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

 private:
  /// The samples that an earlier run left in the folder.
  void read_earlier() {
    const std::filesystem::path path = session_.options().directory / samples_name,
                                record = session_.options().directory / "run.json";
    std::string text;
    parallel::on_root<InputError>(comm_, [&] {
      if (!std::filesystem::exists(path)) return;
      text = whole_file(path);
      if (ensemble::read_samples(text, path.string()).empty()) return;
      const std::string differs = what_differs(record);
      if (!differs.empty())
        throw InputError(
            fmt::format("{} holds samples of another ensemble ({}); choose another folder with -o, or remove "
                        "that file",
                        path.string(), differs));
    });
    samples_ = ensemble::read_samples(comm_.broadcast(text), path.string());
    earlier_ = samples_.size();
  }

  /// What makes the ensemble of `record`, a file run.json, another one than this; empty: nothing does.
  std::string what_differs(const std::filesystem::path& record) const {
    const Json earlier = Json::parse(whole_file(record), nullptr, false);
    if (!earlier.is_object() || !earlier.contains("input") || !input::is_record(earlier["input"]))
      return record.string() + " does not tell of which";
    const auto differences =
        input::differences(earlier["input"], record_of(scene_),
                           [](const std::string& key) { return !only_chooses_samples(key); });
    return differences.empty() ? "" : differences.front().text;
  }

  void open_results() {
    session_.open_record();
    const std::filesystem::path path = session_.folder().claim(samples_name);
    parallel::on_root<RunError>(comm_, [&] { table_ = output::TableFile(path, table_of(samples_)); });
  }

  void print_header() {
    const peridynamics::Parameters& v = scene_.wall->parameters;
    const ensemble::Parameters& e = scene_.ensemble;
    runtime::Console& console = session_.console();
    session_.print_title();
    session_.warn(scene_.warnings);
    console.item("vessel", fmt::format("lumen radius {}, outer radius {}, length {}; ends {}; spacing {}",
                                       quantity(v.inner_radius, "m"), quantity(v.outer_radius, "m"),
                                       quantity(v.length, "m"), name_of(v.ends), quantity(*v.spacing, "m")));
    console.item("pressures",
                 fmt::format("{} from {} to {} ({}), up to {}", e.pressures.size(), mmhg(e.pressures.front()),
                             mmhg(e.pressures.back()), name_of(v.schedule), quantity(v.end_time, "s")));
    console.item("walls", fmt::format("{} (seed {}); spreads: strength {}, thickness {}, stiffness {}",
                                      e.samples, e.seed, text(e.strength_spread), text(e.thickness_spread),
                                      text(e.stiffness_spread)));
    const auto done = e.vessels() - static_cast<long long>(tasks_.size());
    const auto others = static_cast<long long>(earlier_) - done;
    console.item(
        "samples",
        fmt::format("{}, {} of them done before{}", grouped(e.vessels()), grouped(done),
                    others > 0 ? fmt::format("; {} others in samples.csv count too", grouped(others)) : ""));
    session_.print_surroundings();
  }

  void run_samples() {
    const runtime::InterruptGuard guard;
    const auto ranks = static_cast<std::size_t>(comm_.size());
    const auto total = static_cast<long>(scene_.ensemble.vessels());
    const auto progress = [&](std::size_t next) {
      session_.console().progress(total - static_cast<long>(tasks_.size() - next), total,
                                  fmt::format("{} ruptured", grouped(count_ruptured(samples_))), "sample");
    };
    progress(0);
    std::size_t each = 1;  // samples of a rank in a round
    for (std::size_t next = 0; next < tasks_.size() && signal_ == 0;) {
      const std::size_t count = std::min(each * ranks, tasks_.size() - next);
      const double start = seconds_now();
      signal_ = run_round(std::span(tasks_).subspan(next, count));
      const double per_sample =
          comm_.all_reduce((seconds_now() - start) / static_cast<double>(each), parallel::Reduce::max);
      each = static_cast<std::size_t>(std::clamp(round_s / per_sample, 1.0, 1000.0));
      next += count;
      if (signal_ == 0) progress(next);
    }
  }

  /// Does these tasks and keeps what has come of them. The signal that ended it, or 0.
  int run_round(std::span<const ensemble::Task> tasks) {
    ensemble::Round round;
    {
      const Stopwatch watch(session_.spent().solve);
      round =
          ensemble::simulate_round(scene_.ensemble, *scene_.wall, tasks, runtime::InterruptGuard::requested,
                                   comm_, bond_evaluations_, sample_s_);
    }
    keep(round.samples);
    if (!round.failure.empty()) throw RunError(round.failure);
    const auto signal =
        comm_.all_reduce(std::int64_t{runtime::InterruptGuard::requested()}, parallel::Reduce::max);
    return samples_.size() - earlier_ < tasks_.size() ? static_cast<int>(signal) : 0;
  }

  void keep(const std::vector<Sample>& finished) {
    const Stopwatch watch(session_.spent().output);
    append(samples_, finished);
    parallel::on_root<RunError>(comm_, [&] {
      std::string rows;
      for (const Sample& s : finished) rows += ensemble::row(s);
      table_.append(rows);
    });
  }

  /// Puts all samples in order, whatever runs they come from, and counts.
  void finish() {
    const std::size_t now = samples_.size() - earlier_;
    std::sort(samples_.begin(), samples_.end(), ensemble::comes_before);
    probabilities_ = ensemble::probabilities(samples_);
    {
      const Stopwatch watch(session_.spent().output);
      const std::filesystem::path samples = session_.folder().claim(samples_name),
                                  probability = session_.folder().claim(probability_name);
      parallel::on_root<RunError>(comm_, [&] {
        output::write_atomically(samples, table_of(samples_));
        output::write_atomically(probability, ensemble::probability_table(probabilities_));
      });
    }
    const double sample_s = comm_.all_reduce(sample_s_, parallel::Reduce::sum);
    std::int64_t steps = 0;
    for (const Sample& s : samples_) steps += s.steps;
    if (now > 0) seconds_each_ = sample_s / static_cast<double>(now);
    results_.ensemble = {{"pressures", probabilities_.size()},
                         {"samples", samples_.size()},
                         {"samples_of_earlier_runs", earlier_},
                         {"ruptured", count_ruptured(samples_)},
                         {"steps", steps},
                         {"rank_seconds_per_sample", output::or_null(seconds_each_)},
                         {"samples_left", static_cast<std::int64_t>(tasks_.size() - now)}};
  }

  void print_summary() {
    runtime::Console& console = session_.console();
    if (signal_ != 0) {
      console.important(
          fmt::format("Interrupted by {}; finished samples are saved. The same command goes on.",
                      runtime::signal_name(signal_)));
    } else {
      console.line("Done.");
    }
    console.line("    pressure    samples  ruptured  probability   95 % interval   mean onset");
    for (const ensemble::Probability& p : probabilities_) {
      const auto [low, high] = p.interval();
      console.line(fmt::format("  {:>12}  {:>7}  {:>8}  {:>11.3f}  {:.3f} to {:.3f}  {:>11}",
                               mmhg(p.pressure), p.samples, p.ruptured, p.value(), low, high,
                               p.mean_onset ? quantity(*p.mean_onset, "s", 3) : "none"));
    }
    console.item("samples",
                 fmt::format("{} in all, {} new; {}", grouped(static_cast<long long>(samples_.size())),
                             grouped(static_cast<long long>(samples_.size() - earlier_)),
                             seconds_each_ ? quantity(*seconds_each_, "s", 3) + " each on one rank"
                                           : "none simulated"));
    session_.print_cost(session_.performance());
  }

  EnsembleScene scene_;
  parallel::Communicator comm_;
  Results results_;
  runtime::RunSession session_;
  std::vector<Sample> samples_;        ///< all that are known, on every rank
  std::vector<ensemble::Task> tasks_;  ///< samples to do
  std::vector<ensemble::Probability> probabilities_;
  output::TableFile table_;
  int signal_ = 0;                           ///< that ended it
  std::size_t earlier_ = 0;                  ///< samples that an earlier run had done
  double sample_s_ = 0;                      ///< spent in samples by this rank
  std::optional<double> seconds_each_ = {};  ///< time of a sample on one rank; none: no sample was simulated
  std::int64_t bond_evaluations_ = 0;
};

}  // namespace

runtime::Ending run(EnsembleScene scene, const runtime::RunOptions& options, parallel::Communicator comm) {
  return EnsembleRun(std::move(scene), options, comm).run();
}

}  // namespace rhexis::scenes
