// SPDX-License-Identifier: BSD-3-Clause
// Time and error of the solvers of explicit networks.
//
//   network_solvers [JUNCTIONS] [--json FILE]      lattice of degree <= 3 with loops, conductances lognormal,
//                                                  stretched to a contrast of 1e12 (default 200000 junctions)
//
// Errors are the largest difference of a flow, relative to the inflow, from the most accurate solution: that
// of the approximate Cholesky factor refined to 1e-14.
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "hemodynamics/steady/graph/graph_flow.hpp"
#include "networks.hpp"
#include "parallel/communicator.hpp"

namespace {

using namespace rhexis;
using hemodynamics::GraphSolver;
using hemodynamics::solve_flow;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Resident bytes now, or the most since the peak was last forgotten.
double memory(const std::string& field) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kibibytes = 0;
    if (word == field && status >> kibibytes) return 1024 * kibibytes;
  }
  return NAN;
}

void forget_peak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

struct Method {
  GraphSolver solver;
  double imbalance;
};

int lattice(int junctions, const std::string& json_file) {
  const auto graph = networks::lattice(static_cast<int>(std::ceil(std::cbrt(junctions))), 5);
  const std::vector<double> g = networks::conductances(graph.vessels(), 1e12, 6);
  const std::vector<network::BoundaryCondition> conditions{
      networks::pressure(0, 12000), networks::pressure(static_cast<std::uint32_t>(graph.junctions - 1), 500)};
  const auto exact = solve_flow(graph, g, conditions, {GraphSolver::approximate_cholesky, 1e-14, 100000});
  fmt::print("{} junctions, {} vessels, {} unknowns after reduction, {} threads\n", graph.junctions,
             graph.vessels(), exact.core_junctions, parallel::thread_count());
  fmt::print("{:<22}{:>10}{:>10}{:>12}{:>12}{:>12}{:>10}\n", "solver", "asked for", "seconds", "iterations",
             "imbalance", "flow error", "MB");
  std::vector<Method> methods;
  for (const auto solver : {GraphSolver::approximate_cholesky, GraphSolver::amg, GraphSolver::jacobi}) {
    for (const double imbalance : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) methods.push_back({solver, imbalance});
  }
  // The factor is most of the time, whatever is asked for.
  for (const double imbalance : {1e-6, 1e-12}) methods.push_back({GraphSolver::ldlt, imbalance});
  auto rows = nlohmann::json::array();
  for (const auto& [solver, imbalance] : methods) {
    nlohmann::json row{{"solver", name_of(solver)}, {"asked_for", imbalance}};
    try {
      forget_peak();
      const double before = memory("VmRSS:");
      const auto start = std::chrono::steady_clock::now();
      const auto result = solve_flow(graph, g, conditions, {solver, imbalance, 200000});
      const double seconds = seconds_since(start), used = memory("VmHWM:") - before;
      double error = 0;
      for (std::size_t v = 0; v < graph.vessels(); ++v) {
        error = std::max(error, std::abs(result.flow[v] - exact.flow[v]) / exact.inflow);
      }
      row["seconds"] = seconds;
      row["iterations"] = result.iterations;
      row["imbalance"] = result.max_imbalance;
      row["flow_error"] = error;
      row["bytes"] = used;
      fmt::print("{:<22}{:>10.0e}{:>10.3f}{:>12}{:>12.1e}{:>12.1e}{:>10.0f}\n", name_of(solver), imbalance,
                 seconds, result.iterations, result.max_imbalance, error, used / 1e6);
    } catch (const RunError& failure) {
      row["failed"] = failure.what();
      fmt::print("{:<22}{:>10.0e}  {}\n", name_of(solver), imbalance, failure.what());
    }
    std::fflush(stdout);
    rows.push_back(row);
  }
  if (json_file.empty()) return 0;
  std::ofstream out(json_file);
  out << nlohmann::json{{"junctions", graph.junctions},
                        {"vessels", graph.vessels()},
                        {"contrast", 1e12},
                        {"threads", parallel::thread_count()},
                        {"methods", rows}}
             .dump(2)
      << '\n';
  return out ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  parallel::Session session(argc, argv);
  int junctions = 200000;
  std::string json_file;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--json" && i + 1 < argc) {
      json_file = argv[++i];
    } else {
      junctions = std::atoi(argv[i]);
    }
  }
  return lattice(junctions, json_file);
}
