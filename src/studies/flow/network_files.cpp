// SPDX-License-Identifier: BSD-3-Clause
#include "studies/flow/network_files.hpp"

#include "network/files/vtp_network.hpp"
#include "output/atomic_file.hpp"
#include "output/line_series.hpp"
#include "output/temporary_file.hpp"
#include "parallel/together.hpp"
#include "studies/flow/network_tables.hpp"

namespace rhexis::studies {
namespace {

constexpr const char* lines_name = "network";  ///< without an ending
constexpr const char* vtp_name = "network.vtp";
constexpr const char* generations_name = "generations.csv";
constexpr const char* histograms_name = "histograms.csv";
constexpr const char* vessels_name = "vessels.csv";
constexpr const char* screening_name = "screening.csv";
constexpr const char* risks_name = "risk_histograms.csv";

void write_tables(const SolvedNetwork& network, const output::ResultsFolder& folder,
                  parallel::Communicator comm) {
  parallel::together(comm, [&] {
    if (!comm.is_root()) return;
    const auto write = [&](const char* name, const std::string& table) {
      output::write_atomically(folder.claim_on_root(name), table);
    };
    const hemodynamics::NetworkSolution& solution = network.solution;
    if (solution.statistics) {
      write(generations_name, generation_table(*solution.statistics));
      write(histograms_name, histogram_table(*solution.statistics));
    }
    if (network.screened) {
      write(screening_name, screening_table(*network.screened));
      write(risks_name, risk_table(network.screened->screening));
    }
    if (!solution.table.empty()) {
      write(vessels_name, vessel_table(solution.table));
    }
  });
}

/// The first rank's lines, which are all but of a distributed network.
void write_vtp(hemodynamics::VesselLines& lines, const output::ResultsFolder& folder) {
  const auto values = [&](const char* name) {
    const FieldView view = lines.field(name);
    return std::span<const double>(view.component[0], view.count);
  };
  const auto copy = [&](const char* name) {
    return std::vector<double>(values(name).begin(), values(name).end());
  };
  const FieldView position = lines.positions();
  network::Graph graph;
  graph.junctions = position.count;
  graph.x.assign(position.component[0], position.component[0] + position.count);
  graph.y.assign(position.component[1], position.component[1] + position.count);
  graph.z.assign(position.component[2], position.component[2] + position.count);
  const auto ends = lines.connectivity();
  for (std::size_t i = 0; i < ends.size(); i += 2) {
    graph.from.push_back(static_cast<std::uint32_t>(ends[i]));
    graph.to.push_back(static_cast<std::uint32_t>(ends[i + 1]));
  }
  graph.radius = copy("radius");
  graph.length = copy("length");
  for (const double kind : values("kind")) graph.kind.push_back(static_cast<network::VesselKind>(kind));
  for (const double generation : values("generation")) {
    graph.generation.push_back(static_cast<std::int8_t>(generation));
  }
  const network::NamedArray points[] = {{"pressure", values("pressure")}};
  std::vector<network::NamedArray> cells;
  for (const char* name : {"flow", "wall_shear_stress", "hoop_strain", "haematocrit", "vessel"}) {
    cells.push_back({name, values(name)});
  }
  output::TemporaryFile file(folder.claim_on_root(vtp_name));
  network::write_vtp_network(file.name(), graph, points, cells);
  file.put_in_place();
}

void write_lines(const NetworkFilesPlan& files, hemodynamics::NetworkSolution& solution,
                 const output::ResultsFolder& folder, parallel::Communicator comm) {
  if (comm.all_reduce(static_cast<std::int64_t>(solution.display.lines.count()), parallel::Reduce::sum) == 0)
    return;
  solution.display.lines.moment(0, 0,
                                {{"vessels", "1", static_cast<double>(solution.flow.vessels)},
                                 {"shown", "1", static_cast<double>(solution.display.shown)},
                                 {"inflow", "m3/s", solution.flow.inflow}});
  const auto fields = solution.display.lines.fields();
  output::LineSeriesPlan plan;
  plan.directory = folder.path();
  plan.basename = lines_name;
  plan.title = files.title;
  plan.version = files.version;
  plan.fields.assign(fields.begin(), fields.end());
  plan.steps = {0};
  plan.precision = Precision::double_precision;
  plan.formats = files.formats;
  for (const std::string& name : output::series_files(lines_name, plan.formats)) folder.claim(name);
  output::LineSeries(plan, solution.display.lines, comm).write(solution.display.lines);
  if (!files.vtp) return;
  parallel::together(comm, [&] {
    if (comm.is_root()) write_vtp(solution.display.lines, folder);
  });
}

}  // namespace

std::vector<std::string> network_file_names(const NetworkFilesPlan& plan,
                                            const hemodynamics::FlowProblem& problem, bool screens) {
  std::vector<std::string> names = output::series_files(lines_name, plan.formats);
  const bool is_implicit = problem.network.resolved_tier() == network::Tier::implicit_tree;
  if (is_implicit && problem.network.statistics) {
    names.emplace_back(generations_name);
    names.emplace_back(histograms_name);
  }
  if (!is_implicit) names.emplace_back(vessels_name);
  if (screens) {
    names.emplace_back(screening_name);
    names.emplace_back(risks_name);
  }
  if (plan.vtp) names.emplace_back(vtp_name);
  return names;
}

void write_network(const NetworkFilesPlan& plan, SolvedNetwork& network, const output::ResultsFolder& folder,
                   parallel::Communicator comm) {
  write_tables(network, folder, comm);
  write_lines(plan, network.solution, folder, comm);
}

}  // namespace rhexis::studies
