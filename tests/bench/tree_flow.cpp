// SPDX-License-Identifier: BSD-3-Clause
// Time and error of the recursion on random tree pairs, vessel by vessel.
//
//   tree_flow [--json FILE] [GENERATIONS...]       default 12 16 20 24 28
//
// Seconds a vessel of the way up (total flow) and of the way down with statistics; errors are the largest of
// all vessels against plain recursion in long double, up to 22 generations (memory).
#include "hemodynamics/steady/tree/tree_flow.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hemodynamics/steady/tree/tree_statistics.hpp"
#include "parallel/communicator.hpp"
#include "support/trees.hpp"

namespace {

using namespace rhexis;

constexpr double inlet = 12600, outlet = 600;
constexpr int most_in_long_double = 22;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

nlohmann::json measure(int generations, parallel::Communicator comm) {
  const network::TreeRules rules = test::body_rules(generations);
  const network::TreePair tree(rules);
  double start = now();
  const hemodynamics::TreeFlow flow(tree, test::in_vivo(), {inlet, outlet, {}}, comm);
  const double up = now() - start;
  start = now();
  hemodynamics::gather_statistics(flow, test::in_vivo(), comm);
  const double down = now() - start;
  const auto vessels = static_cast<double>(tree.vessels());
  nlohmann::json row{{"generations", generations},  {"vessels", tree.vessels()},
                     {"up_ns", 1e9 * up / vessels}, {"down_ns", 1e9 * down / vessels},
                     {"flow_error", nullptr},       {"pressure_error", nullptr}};
  if (generations <= most_in_long_double) {
    const test::LongDoubleTree exact(rules, test::in_vivo(), inlet, outlet);
    std::vector<std::uint64_t> places;
    for (std::uint64_t p = 1; p <= tree.places(); ++p) places.push_back(p);
    const auto found = flow.at(places);
    double flow_error = 0, pressure_error = 0;
    for (const std::uint64_t p : places) {
      const auto& f = found[p - 1];
      flow_error = std::max(flow_error, static_cast<double>(std::abs(f.flow / exact.flow[p] - 1)));
      pressure_error =
          std::max({pressure_error,
                    static_cast<double>(std::abs(f.artery_far - exact.artery_far[p])) / (inlet - outlet),
                    static_cast<double>(std::abs(f.vein_far - exact.vein_far[p])) / (inlet - outlet)});
    }
    row["flow_error"] = flow_error;
    row["pressure_error"] = pressure_error;
  }
  return row;
}

}  // namespace

int main(int argc, char** argv) {
  const parallel::Session session(argc, argv);
  const auto world = parallel::Communicator::world();
  std::string json;
  std::vector<int> generations;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--json" && i + 1 < argc) {
      json = argv[++i];
    } else {
      generations.push_back(std::atoi(argv[i]));
    }
  }
  if (generations.empty()) generations = {12, 16, 20, 24, 28};
  nlohmann::json table = nlohmann::json::array();
  if (world.is_root())
    fmt::print("generations  vessels       up ns/vessel  down ns/vessel  flow error  pressure error\n");
  for (const int k : generations) {
    const nlohmann::json row = measure(k, world);
    table.push_back(row);
    const auto error = [&](const char* name) {
      return row[name].is_null() ? "-" : fmt::format("{:.1e}", row[name].get<double>());
    };
    if (world.is_root()) {
      fmt::print("{:11}  {:<12}  {:12.3f}  {:14.3f}  {:>10}  {:>14}\n", k,
                 row["vessels"].get<std::uint64_t>(), row["up_ns"].get<double>(),
                 row["down_ns"].get<double>(), error("flow_error"), error("pressure_error"));
    }
  }
  if (world.is_root() && !json.empty()) std::ofstream(json) << table.dump(1) << '\n';
  return 0;
}
