// SPDX-License-Identifier: BSD-3-Clause
/// Threads behind two words: a fixed number of workers, each given one contiguous share.
#pragma once

#include <cstddef>

namespace rhexis::parallel {

/// The number of the calling thread within the parallel region that it is in.
int thread_number();

/// Calls `work(thread, begin, end)` once on each thread, with contiguous shares of [0, count) that are the
/// same in every call: a thread meets the same data each step. `work` must not throw.
template <class Work>
void for_each_share(int threads, std::size_t count, const Work& work) {
#pragma omp parallel for schedule(static, 1) num_threads(threads)
  for (int t = 0; t < threads; ++t) {
    const auto share = [&](int k) {
      return count * static_cast<std::size_t>(k) / static_cast<std::size_t>(threads);
    };
    work(t, share(t), share(t + 1));
  }
}

/// Calls `work(thread, i)` for every i of [0, count), each as a thread becomes free, on threads [0, threads).
/// `work` must not throw.
template <class Work>
void for_each_task(int threads, std::size_t count, const Work& work) {
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (std::size_t i = 0; i < count; ++i) work(thread_number(), i);
}

}  // namespace rhexis::parallel
