// What a frame of the paper's vessel costs: its fields evaluated, forces included, which the next step then
// has; stored as particles; stored as a checkpoint.
//
// of_peak: of what is written, bytes/s over those of writing as many bytes to a plain file in the same
// folder, in place of earlier ones, and waiting until they are on disk; of the fields, flop/s counted as for
// a step over the peak of fused multiply-adds.
#include <omp.h>
#include <unistd.h>

#include <chrono>
#include <set>

#include "bench/cases.hpp"
#include "output/checkpoint.hpp"
#include "output/point_series.hpp"
#include "peridynamics/bond_kernel.hpp"
#include "peridynamics/particle_source.hpp"
#include "support/vessels.hpp"

namespace rhexis::bench {
namespace {

constexpr double pressure = 1e4;

/// A folder that goes with its owner.
struct Folder {
  explicit Folder(const std::filesystem::path& parent)
      : path(parent / ("rhexis_bench_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::filesystem::path path;
};

std::unique_ptr<peridynamics::Body> body_of(int rows) {
  auto setup = test::setup_of(test::paper_vessel(rows * 1e-4), 1e-9);
  setup.time_step = 0.5 * test::stable_step_of(setup);
  auto body = peridynamics::make_body(std::move(setup), test::self());
  for (int i = 0; i < 3; ++i) body->advance(pressure, pressure);
  return body;
}

/// Frames of `bytes` each in `folder`, stored by `store`.
template <class Store>
void write_frames(benchmark::State& state, double bytes, const peridynamics::Body& body,
                  const std::filesystem::path& folder, const Store& store) {
  PlainFile file(folder, static_cast<std::size_t>(bytes));
  const Medians found = measure(
      state, [&] { return file.rate(); },
      [&] {
        const auto start = std::chrono::steady_clock::now();
        store();
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        return Sample{seconds.count(), bytes};
      });
  state.counters["bytes"] = bytes;
  state.counters["bytes_per_s"] = found.rate;
  state.counters["ms_per_frame"] = 1e3 * found.seconds;
  state.counters["particles"] = static_cast<double>(body.layout().local_count());
}

void fields(benchmark::State& state, int rows, int threads) {
  omp_set_num_threads(threads);
  const auto body = body_of(rows);
  const double flop = peridynamics::flop_per_bond * static_cast<double>(body->bonds());
  const auto peak = [&] { return fma_rate<float>(threads); };
  const Medians found = measure(state, peak, [&] {
    body->advance(pressure, pressure);
    const double start = now(threads);
    body->observe(pressure);
    return Sample{now(threads) - start, flop};
  });
  state.counters["ms_per_frame"] = 1e3 * found.seconds;
  state.counters["particles"] = static_cast<double>(body->layout().local_count());
}

void particles(benchmark::State& state, int rows, int samples, const std::filesystem::path& scratch) {
  const Folder folder(scratch);
  const auto body = body_of(rows);
  peridynamics::ParticleSource source(*body);
  output::PointSeriesPlan plan;
  plan.directory = folder.path;
  for (const FieldInfo& field : source.fields()) plan.fields.push_back(field);
  for (long step = 0; step < samples; ++step) plan.steps.push_back(step);
  output::PointSeries series(plan, body->layout(), test::self());
  const auto& observation = body->observe(pressure);
  double bytes = 3 * sizeof(float) * static_cast<double>(body->layout().local_count());
  for (const FieldInfo& field : plan.fields) {
    bytes += field.components * static_cast<double>(sizeof(float)) *
             static_cast<double>(body->layout().local_count());
  }
  long step = 0;
  write_frames(state, bytes, *body, folder.path, [&] {
    source.moment(step, static_cast<double>(step), observation, {{"pressure", "Pa", pressure}});
    series.write(source);
    series.finish();
    ++step;
  });
}

void checkpoint(benchmark::State& state, int rows, const std::filesystem::path& scratch) {
  const Folder folder(scratch);
  const auto body = body_of(rows);
  const auto size = body->save();
  const peridynamics::BondWordLayout l = body->bond_word_layout();
  const output::WordBlock words{l.rows, l.words, l.first_row, l.row_count, l.first_word, l.word_count};
  const double bytes = static_cast<double>(6 * sizeof(double) * size.displacement[0].size() +
                                           sizeof(std::uint16_t) * size.words.size());
  write_frames(state, bytes, *body, folder.path, [&] {
    const auto saved = body->save();
    output::CheckpointWriter file(folder.path / "checkpoint.h5", test::self());
    for (int i = 0; i < 16; ++i) file.write("number_" + std::to_string(i), 1.0);  // as many as VesselRun's
    for (std::size_t k = 0; k < 3; ++k) {
      file.write("displacement_" + std::to_string(k), body->layout(), saved.displacement[k]);
      file.write("velocity_" + std::to_string(k), body->layout(), saved.leapfrog_velocity[k]);
    }
    file.write("intact_bonds", words, saved.words);
    file.close();
  });
}

}  // namespace

void add_cases(const Options& options) {
  for (const int rows : {100, 1000}) {
    const std::string end = "/rows=" + std::to_string(rows);
    for (const int threads : std::set{1, omp_get_num_procs()}) {
      add_case("output/frame=fields" + end + "/threads=" + std::to_string(threads), options.samples,
               [=](benchmark::State& state) { fields(state, rows, threads); });
    }
    add_case("output/frame=particles" + end, options.samples,
             [=](benchmark::State& state) { particles(state, rows, options.samples, options.scratch); });
    add_case("output/frame=checkpoint" + end, options.samples,
             [=](benchmark::State& state) { checkpoint(state, rows, options.scratch); });
  }
}

}  // namespace rhexis::bench
