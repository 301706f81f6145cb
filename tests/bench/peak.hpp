// SPDX-License-Identifier: BSD-3-Clause
// What this machine can do at most, measured: the yardsticks of the benchmarks.
//
// Rates are sums over `threads` threads that work at the same time. Each takes its best of some bursts of
// about a third of a millisecond of its own processor time: what disturbs the machine for a moment is no
// property of it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <numeric>
#include <vector>

#include "parallel/threads.hpp"

namespace rhexis::bench {

/// Seconds of processor of the calling thread.
double processor_time();

/// Sum over threads of the best rate of each; `burst(thread)` returns how much it did.
template <class Burst>
double best_rate(int threads, const Burst& burst) {
  constexpr int bursts = 4;
  std::vector<double> best(static_cast<std::size_t>(threads));
  parallel::for_each_share(threads, best.size(), [&](int thread, std::size_t, std::size_t) {
    double& mine = best[static_cast<std::size_t>(thread)];
    for (int i = 0; i < bursts; ++i) {
      const double start = processor_time(), amount = burst(thread);
      mine = std::max(mine, amount / (processor_time() - start));
    }
  });
  return std::accumulate(best.begin(), best.end(), 0.0);
}

/// Seconds. Of one thread those of the processor, which other programs do not lengthen; of several, which
/// wait for each other, those of the clock on the wall.
double now(int threads);

/// flop/s of fused multiply-adds (two flop a lane) in vectors, 12 independent chains a thread.
template <class Real>
double fma_rate(int threads);

/// B/s read from half of a data cache of this level, 1 or 2.
double load_rate(int threads, int level);

/// B/s of STREAM's triad, a = b + s c, 24 B an element, in arrays larger than the last cache.
double memory_rate(int threads);

/// A file without a name in `folder`, to be written again and again.
class PlainFile {
 public:
  PlainFile(const std::filesystem::path& folder, std::size_t bytes);
  ~PlainFile();
  PlainFile(const PlainFile&) = delete;
  PlainFile& operator=(const PlainFile&) = delete;
  /// B/s of writing `bytes` in place of the earlier ones and waiting until they are on disk.
  double rate();

 private:
  std::size_t bytes_;
  int file_;
};

}  // namespace rhexis::bench
