// SPDX-License-Identifier: BSD-3-Clause
#include "bench/peak.hpp"

#include <fcntl.h>
#include <hwy/aligned_allocator.h>
#include <hwy/highway.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <stdexcept>
#include <vector>

#include "parallel/threads.hpp"

namespace rhexis::bench {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

double wall_time() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Bytes of a cache as the C library knows it, or what is usual where it does not.
std::size_t cache_bytes(int name, std::size_t usual) {
  const long bytes = sysconf(name);
  return bytes > 0 ? static_cast<std::size_t>(bytes) : usual;
}

}  // namespace

double processor_time() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double now(int threads) {
  return threads == 1 ? processor_time() : wall_time();
}

template <class Real>
double fma_rate(int threads) {
  constexpr int chains = 12, rounds = 150000;
  return best_rate(threads, [](int) {
    const hn::ScalableTag<Real> d;
    const auto half = hn::Set(d, Real(0.5)), one = hn::Set(d, Real(1));
    hn::Vec<decltype(d)> x[chains];
    for (int k = 0; k < chains; ++k) x[k] = hn::Set(d, static_cast<Real>(k));
    for (int i = 0; i < rounds; ++i) {
      for (int k = 0; k < chains; ++k) x[k] = hn::MulAdd(x[k], half, one);  // towards 2: ordinary numbers
    }
    for (int k = 1; k < chains; ++k) x[0] = hn::Add(x[0], x[k]);
    [[maybe_unused]] const volatile Real needed = hn::GetLane(x[0]);
    return 2.0 * chains * rounds * static_cast<double>(hn::Lanes(d));
  });
}

template double fma_rate<float>(int);
template double fma_rate<double>(int);

double load_rate(int threads, int level) {
  constexpr std::size_t chains = 8, bytes_a_burst = std::size_t{64} << 20;
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d), at_once = chains * lanes;
  const std::size_t cache = level == 1 ? cache_bytes(_SC_LEVEL1_DCACHE_SIZE, 32 << 10)
                                       : cache_bytes(_SC_LEVEL2_CACHE_SIZE, 512 << 10);
  const std::size_t count = cache / 2 / sizeof(float) / at_once * at_once;
  std::vector<hwy::AlignedFreeUniquePtr<float[]>> data;
  for (int t = 0; t < threads; ++t) {
    data.push_back(hwy::AllocateAligned<float>(count));
    std::fill_n(data.back().get(), count, 0.0f);
  }
  const std::size_t passes = bytes_a_burst / (count * sizeof(float));
  return best_rate(threads, [&](int thread) {
    const float* from = data[static_cast<std::size_t>(thread)].get();
    hn::Vec<decltype(d)> sum[chains];
    for (auto& s : sum) s = hn::Zero(d);
    for (std::size_t pass = 0; pass < passes; ++pass) {
      for (std::size_t i = 0; i < count; i += at_once) {
        for (std::size_t k = 0; k < chains; ++k) {
          sum[k] = hn::Add(sum[k], hn::Load(d, from + i + k * lanes));
        }
      }
    }
    for (std::size_t k = 1; k < chains; ++k) sum[0] = hn::Add(sum[0], sum[k]);
    [[maybe_unused]] const volatile float needed = hn::GetLane(sum[0]);
    return static_cast<double>(passes * count * sizeof(float));
  });
}

double memory_rate(int threads) {
  constexpr std::size_t least = std::size_t{256} << 20;
  static const std::size_t count = std::max(least, cache_bytes(_SC_LEVEL3_CACHE_SIZE, 0)) / sizeof(double);
  static std::vector<double> a(count, 1.0), b(count, 2.0), c(count, 3.0);
  double best = 0;
  for (int i = 0; i < 2; ++i) {
    const double start = now(threads);
    parallel::for_each_share(threads, count, [&](int, std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) a[k] = b[k] + 3.0 * c[k];
    });
    best = std::max(best, 3 * static_cast<double>(count * sizeof(double)) / (now(threads) - start));
  }
  return best;
}

PlainFile::PlainFile(const std::filesystem::path& folder, std::size_t bytes) : bytes_(bytes) {
  const std::string path = (folder / "yardstick").string();
  file_ = open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (file_ < 0) throw std::runtime_error(path + ": cannot create the file");
  unlink(path.c_str());  // gone when closed, however the program ends
  rate();
}

PlainFile::~PlainFile() {
  close(file_);
}

double PlainFile::rate() {
  const std::vector<char> part(std::min(bytes_, std::size_t{1} << 20), 'x');
  bool good = true;
  const double start = wall_time();
  for (std::size_t done = 0; good && done < bytes_; done += part.size()) {
    const std::size_t count = std::min(part.size(), bytes_ - done);
    good = pwrite(file_, part.data(), count, static_cast<off_t>(done)) == static_cast<ssize_t>(count);
  }
  good = good && fsync(file_) == 0;
  if (!good) throw std::runtime_error("cannot write a file to compare with");
  return static_cast<double>(bytes_) / (wall_time() - start);
}

}  // namespace rhexis::bench
