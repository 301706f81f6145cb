// SPDX-License-Identifier: BSD-3-Clause
// What a frame of the paper's vessel costs: its fields evaluated, forces included, which the next step then
// has; stored as particles; stored as a checkpoint. And what an output of a tiny body costs when it is the
// 10th, 1,000th and 10,000th of a run: where the files are, not what is in them.
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
#include "peridynamics/engine/bond_kernel.hpp"
#include "peridynamics/monitors/particle_source.hpp"
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
  state.counters["particles"] = static_cast<double>(body.ids().local_count());
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
  state.counters["particles"] = static_cast<double>(body->ids().local_count());
}

void particles(benchmark::State& state, int rows, int samples, const std::filesystem::path& scratch) {
  const Folder folder(scratch);
  const auto body = body_of(rows);
  peridynamics::ParticleSource source(*body);
  output::PointSeriesPlan plan;
  plan.directory = folder.path;
  for (const FieldInfo& field : source.fields()) plan.fields.push_back(field);
  for (long step = 0; step < samples; ++step) plan.steps.push_back(step);
  output::PointSeries series(plan, body->ids(), test::self());
  const auto& observation = body->observe(pressure);
  double bytes = 3 * sizeof(float) * static_cast<double>(body->ids().local_count());
  for (const FieldInfo& field : plan.fields) {
    bytes += field.components * static_cast<double>(sizeof(float)) *
             static_cast<double>(body->ids().local_count());
  }
  long step = 0;
  write_frames(state, bytes, *body, folder.path, [&] {
    source.moment(step, static_cast<double>(step), observation, {{"pressure", "Pa", pressure}});
    series.write(source);
    series.finish();
    ++step;
  });
}

/// 100 particles with six fields, beside positions, whose values nobody looks at.
class TinySource : public PointSource {
 public:
  void move_on() { ++step_; }
  long step() const override { return step_; }
  double time_s() const override { return 1e-7 * static_cast<double>(step_); }
  const IdRanges& ids() const override { return ids_; }
  std::span<const FieldInfo> fields() const override { return infos; }
  FieldView positions() override { return view_of({"position", "m", 3}); }
  FieldView field(std::string_view name) override {
    return view_of(*std::find_if(infos.begin(), infos.end(), [&](const auto& i) { return i.name == name; }));
  }
  std::vector<Annotation> annotations() const override { return {{"pressure", "Pa", 1.0 / 3 * time_s()}}; }

 private:
  static constexpr std::array<FieldInfo, 6> infos = {
      FieldInfo{"displacement", "m", 3},     FieldInfo{"velocity", "m/s", 3},
      FieldInfo{"force_density", "N/m3", 3}, FieldInfo{"energy", "J/m3", 1},
      FieldInfo{"damage", "1", 1},           FieldInfo{"stretch", "1", 1}};
  FieldView view_of(const FieldInfo& info) const {
    return {info, {values_.data(), values_.data(), values_.data()}, values_.size()};
  }
  IdRanges ids_{.global_count = 100, .ranges = {{0, 100}}};
  std::vector<double> values_ = std::vector<double>(100, 1.0);
  long step_ = 0;
};

void long_series(benchmark::State& state, long outputs, output::SeriesFormat format,
                 const std::filesystem::path& scratch) {
  const Folder folder(scratch);
  TinySource source;
  output::PointSeriesPlan plan;
  plan.directory = folder.path;
  for (const FieldInfo& field : source.fields()) plan.fields.push_back(field);
  for (long step = 0; step < outputs; ++step) plan.steps.push_back(step);
  plan.annotations = {"pressure"};
  plan.formats = {format};
  const double start = now(1);
  output::PointSeries series(plan, source.ids(), test::self());
  state.counters["ms_to_lay_out"] = 1e3 * (now(1) - start);
  std::vector<double> seconds;
  for ([[maybe_unused]] auto _ : state) {
    const auto begin = std::chrono::steady_clock::now();
    series.write(source);
    series.finish();
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    state.SetIterationTime(seconds.back());
    source.move_on();
  }
  for (const std::size_t at : {10, 1000, 10000}) {
    if (at > seconds.size()) break;
    const auto end = seconds.begin() + static_cast<std::ptrdiff_t>(at);
    state.counters["ms_at_" + std::to_string(at)] = 1e3 * median({end - 10, end});
  }
}

void checkpoint(benchmark::State& state, int rows, const std::filesystem::path& scratch) {
  const Folder folder(scratch);
  const auto body = body_of(rows);
  const auto size = body->save();
  const double bytes = static_cast<double>(6 * sizeof(double) * size.displacement[0].size() +
                                           sizeof(std::uint16_t) * size.words.size());
  write_frames(state, bytes, *body, folder.path, [&] {
    const auto saved = body->save();
    output::CheckpointWriter file(folder.path / "checkpoint.h5", "bench", test::self());
    for (int i = 0; i < 16; ++i) file.write("number_" + std::to_string(i), 1.0);  // as many as VesselRun's
    for (std::size_t k = 0; k < 3; ++k) {
      file.write("displacement_" + std::to_string(k), body->ids(), saved.displacement[k]);
      file.write("velocity_" + std::to_string(k), body->ids(), saved.leapfrog_velocity[k]);
    }
    file.write("intact_bonds", body->word_table(), saved.words);
    file.close();
  });
}

}  // namespace

void add_cases(const Options& options) {
  for (const auto& [name, format] :
       {std::pair("xdmf", output::SeriesFormat::xdmf), std::pair("vtkhdf", output::SeriesFormat::vtkhdf)}) {
    const int outputs = 10000;
    add_case(std::string("series/format=") + name + "/outputs=" + std::to_string(outputs), outputs,
             [=, format = format](benchmark::State& state) {
               long_series(state, outputs, format, options.scratch);
             });
  }
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
