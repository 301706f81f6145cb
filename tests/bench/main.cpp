// SPDX-License-Identifier: BSD-3-Clause
// The main function of every benchmark program:
//
//   bench_... [--samples N] [--scratch FOLDER] [options of Google Benchmark, such as
//   --benchmark_filter=threads=1]
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "bench/cases.hpp"
#include "parallel/communicator.hpp"

namespace {

using rhexis::bench::Options;

/// Takes our own options out of the command line.
Options take_options(int& argc, char** argv) {
  Options options{.scratch = std::filesystem::temp_directory_path()};
  int kept = 1;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--samples" && i + 1 < argc) {
      options.samples = std::max(1, std::atoi(argv[++i]));
    } else if (word == "--scratch" && i + 1 < argc) {
      options.scratch = argv[++i];
    } else {
      argv[kept++] = argv[i];
    }
  }
  argc = kept;
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  const rhexis::parallel::Session session(argc, argv);
  const Options options = take_options(argc, argv);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  try {
    rhexis::bench::add_cases(options);
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "error: %s\n", failure.what());
    return 1;
  }
  benchmark::Shutdown();
  return 0;
}
