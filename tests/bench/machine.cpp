// SPDX-License-Identifier: BSD-3-Clause
// The peaks of this machine, on one thread and on all.
#include <omp.h>

#include <functional>
#include <set>

#include "bench/cases.hpp"

void rhexis::bench::add_cases(const Options& options) {
  const std::pair<const char*, std::function<double(int)>> peaks[] = {
      {"fma=single", fma_rate<float>},
      {"fma=double", fma_rate<double>},
      {"load=L1", [](int threads) { return load_rate(threads, 1); }},
      {"load=L2", [](int threads) { return load_rate(threads, 2); }},
      {"memory=triad", memory_rate},
  };
  for (const auto& [name, peak] : peaks) {
    for (const int threads : std::set{1, omp_get_num_procs()}) {
      add_case(std::string("machine/") + name + "/threads=" + std::to_string(threads), options.samples,
               [peak = peak, threads](benchmark::State& state) {
                 std::vector<double> rates;
                 for ([[maybe_unused]] auto _ : state) {
                   const double start = now(threads);
                   rates.push_back(peak(threads));
                   state.SetIterationTime(now(threads) - start);
                 }
                 state.counters["rate"] = median(rates);
                 state.counters["best"] = *std::max_element(rates.begin(), rates.end());
               });
    }
  }
}
