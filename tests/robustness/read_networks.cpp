// SPDX-License-Identifier: BSD-3-Clause
// Reads networks and solves their flow as `rhexis run` does, one after another, for robustness_study.py
// networks: a start of the program for each of thousands of files would take most of the time.
//
// Standard input: a line for each network, its files with tabs between them. Standard output: a line for
// each, "read", "refused" (by a reader; the program's status 2), "unsolvable" (by the solver; status 2),
// "failed" (status 3) or "not finite", a tab, and what there is to tell.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>
#include <string>

#include "core/error.hpp"
#include "core/printable.hpp"
#include "hemodynamics/steady/flow_solver.hpp"
#include "input/units.hpp"
#include "network/files/network_file.hpp"
#include "parallel/communicator.hpp"

namespace {

using namespace rhexis;

std::string outcome(const std::string& line, parallel::Communicator comm) {
  hemodynamics::FlowProblem problem{.to_si = input::to_si};
  problem.network.source = network::Source::file;
  problem.network.file_length_unit = "mm";
  std::istringstream files(line);
  for (std::string file; std::getline(files, file, '\t');) problem.network.files.push_back(file);
  // SWC knows no conditions.
  if (line.ends_with(".swc"))
    problem.network.conditions = {{.nearest = {0, 0, 0}, .pressure = 8000},
                                  {.nearest = {1, 1, 1}, .pressure = 2000}};
  const char* word = "refused\t";
  try {
    network::read_network(problem.network, problem.to_si);
    word = "unsolvable\t";
    const auto solver = hemodynamics::prepared_solver(problem, comm);
    const hemodynamics::NetworkSolution solution = solver->solve([](const std::string&) {}, nullptr);
    for (const hemodynamics::VesselTableRow& row : solution.table) {
      if (!std::isfinite(row.flow) || !std::isfinite(row.pressure_from) || !std::isfinite(row.pressure_to))
        return "not finite\tvessel " + row.name;
    }
    return "read\t" + std::to_string(solver->vessels()) + " vessels";
  } catch (const InputError& error) {
    return word + std::string(error.what());
  } catch (const RunError& error) {
    return std::string("failed\t") + error.what();
  }
}

}  // namespace

int main(int argc, char** argv) {
  const parallel::Session session(argc, argv);
  for (std::string line; std::getline(std::cin, line);) {
    std::string told = printable(outcome(line, parallel::Communicator::world()));
    std::ranges::replace(told, '\n', ' ');
    std::cout << told << std::endl;  // at once: a crash is that of the next
  }
}
