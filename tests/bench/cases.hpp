// SPDX-License-Identifier: BSD-3-Clause
// What the benchmark programs have in common: their command line, and measuring beside the machine's peak.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/peak.hpp"

namespace rhexis::bench {

struct Options {
  int samples = 15;               ///< of each case
  std::filesystem::path scratch;  ///< folder for files that are written to be timed
};

/// Registers a program's cases; each program has one. Their names are `what/key=value/...`.
void add_cases(const Options& options);

/// One sample: how long it took, and how much was done in units of the peak (flop, B).
struct Sample {
  double seconds = 0, amount = 0;
};

struct Medians {
  double seconds = 0;  ///< of a sample
  double rate = 0;     ///< amount/s
  double of_peak = 0;  ///< rate over the peak at that time
};

inline double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Takes the samples of a case. The clock of a machine that others use swings, so the peak is measured right
/// before and after each sample, which is compared with the mean of the two. Reports the median as `of_peak`.
template <class Peak, class Work>
Medians measure(benchmark::State& state, const Peak& peak, const Work& work) {
  std::vector<double> seconds, rates, ratios;
  double before = peak();
  for ([[maybe_unused]] auto _ : state) {
    const Sample sample = work();
    const double after = peak();
    state.SetIterationTime(sample.seconds);
    seconds.push_back(sample.seconds);
    rates.push_back(sample.amount / sample.seconds);
    ratios.push_back(rates.back() / (0.5 * (before + after)));
    before = after;
  }
  const Medians result{median(seconds), median(rates), median(ratios)};
  state.counters["of_peak"] = result.of_peak;
  return result;
}

/// Registers `run(state)`, which takes `samples` samples.
template <class Run>
void add_case(const std::string& name, int samples, const Run& run) {
  benchmark::RegisterBenchmark(name.c_str(), run)
      ->UseManualTime()
      ->Iterations(samples)
      ->Unit(benchmark::kMillisecond);
}

}  // namespace rhexis::bench
