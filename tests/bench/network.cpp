// SPDX-License-Identifier: BSD-3-Clause
// Vessels a second by tier, on one thread and on all: trees that are not stored, way up and way down, and
// explicit graphs. (The distributed tier: postprocessing/network_speed_and_error.py. Errors: tree_flow.cpp,
// network_solvers.cpp.)
//
// of_peak: of trees that are not stored, counted operations over the peak of fused multiply-adds in double
// precision. Of explicit graphs, which are all memory: the least traffic, everything read and written once,
// over what memory gives.
#include <omp.h>

#include <set>

#include "bench/cases.hpp"
#include "hemodynamics/steady/graph/graph_flow.hpp"
#include "hemodynamics/steady/tree/tree_statistics.hpp"
#include "networks.hpp"
#include "parallel/communicator.hpp"
#include "support/trees.hpp"

namespace rhexis::bench {
namespace {

/// Takes each vessel and does nothing with it.
class Sink final : public hemodynamics::VesselConsumer {
 public:
  void consume(const hemodynamics::VesselBlock&) override {}
};

double double_peak(int threads) {
  return fma_rate<double>(threads);
}

void report(benchmark::State& state, const Medians& found, double vessels) {
  state.counters["vessels"] = vessels;
  state.counters["vessels_per_s"] = vessels / found.seconds;
  state.counters["ns_per_vessel"] = 1e9 * found.seconds / vessels;
}

void tree(benchmark::State& state, int generations, const std::string& way, int threads) {
  omp_set_num_threads(threads);
  const network::TreePair pair(test::body_rules(generations));
  const hemodynamics::TreeBoundary ends{12600, 600, {}};
  const auto comm = parallel::Communicator::self();
  const double places = static_cast<double>(pair.places());
  const hemodynamics::TreeFlow flow(pair, test::in_vivo(), ends, comm);
  const auto work = [&] {
    const double start = now(threads);
    if (way == "up") {
      const hemodynamics::TreeFlow again(pair, test::in_vivo(), ends, comm);
      benchmark::DoNotOptimize(again.resistance());
    } else if (way == "down") {
      std::vector<Sink> sinks(static_cast<std::size_t>(threads));
      flow.sweep([&](int thread) -> Sink& { return sinks[static_cast<std::size_t>(thread)]; });
    } else {
      hemodynamics::gather_statistics(flow, test::in_vivo(), comm);
    }
    return Sample{now(threads) - start,
                  (way == "up" ? hemodynamics::flop_up : hemodynamics::flop_down) * places};
  };
  report(state,
         measure(
             state, [&] { return double_peak(threads); }, work),
         static_cast<double>(pair.vessels()));
}

void graph(benchmark::State& state, const network::Graph& graph, std::uint32_t inlet, std::uint32_t outlet,
           int threads) {
  omp_set_num_threads(threads);
  const std::vector<double> g = networks::conductances(graph.vessels(), 1e6, 1);
  const std::vector<network::BoundaryCondition> ends{networks::pressure(inlet, 12000),
                                                     networks::pressure(outlet, 500)};
  // Two ends and a conductance in, a flow out; a pressure for each junction.
  const double traffic = static_cast<double>(graph.vessels() * (2 * 4 + 8 + 8) + graph.junctions * 8);
  const auto work = [&] {
    std::vector<double> consumed = g;
    const double start = now(threads);
    benchmark::DoNotOptimize(hemodynamics::solve_flow(graph, std::move(consumed), ends).inflow);
    return Sample{now(threads) - start, traffic};
  };
  report(state,
         measure(
             state, [&] { return memory_rate(threads); }, work),
         static_cast<double>(graph.vessels()));
}

}  // namespace

void add_cases(const Options& options) {
  const int samples = std::max(1, options.samples / 3);  // a second each
  for (const int threads : std::set{1, omp_get_num_procs()}) {
    const std::string end = "/threads=" + std::to_string(threads);
    for (const std::string way : {"up", "down", "statistics"}) {
      constexpr int generations = 26;
      add_case("network/tier=implicit/generations=" + std::to_string(generations) + "/way=" + way + end,
               samples, [=](benchmark::State& state) { tree(state, generations, way, threads); });
    }
    add_case("network/tier=explicit/graph=tree_pair" + end, samples, [=](benchmark::State& state) {
      const auto pair = networks::tree_pair(20);
      graph(state, pair.graph, pair.inlet, pair.outlet, threads);
    });
    add_case("network/tier=explicit/graph=loops" + end, samples, [=](benchmark::State& state) {
      const auto loops = networks::lattice(60, 5);
      graph(state, loops, 0, static_cast<std::uint32_t>(loops.junctions - 1), threads);
    });
  }
}

}  // namespace rhexis::bench
