#include "app/network_files.hpp"

#include "app/network_tables.hpp"
#include "network/vtp_network.hpp"
#include "output/atomic_file.hpp"
#include "output/line_series.hpp"
#include "output/temporary_file.hpp"
#include "parallel/together.hpp"
#include "runtime/version.hpp"

namespace rhexis::app {
namespace {

void write_tables(const NetworkSolution& solution, const output::ResultsFolder& folder,
                  parallel::Communicator comm) {
  parallel::together(comm, [&] {
    if (!comm.is_root()) return;
    const auto write = [&](const char* name, const std::string& table) {
      output::write_atomically(folder.claim_on_root(name), table);
    };
    if (solution.statistics) {
      write("generations.csv", generation_table(*solution.statistics));
      write("histograms.csv", histogram_table(*solution.statistics));
    }
    if (solution.screening) {
      write("screening.csv", screening_table(solution));
      write("risk_histograms.csv", risk_table(*solution.screening));
    }
    if (!solution.table.empty()) {
      write("vessels.csv", vessel_table(solution.table));
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
  output::TemporaryFile file(folder.claim_on_root("network.vtp"));
  network::write_vtp_network(file.name(), graph, points, cells);
  file.put_in_place();
}

void write_lines(const Configuration& c, NetworkSolution& solution, const output::ResultsFolder& folder,
                 parallel::Communicator comm) {
  if (comm.all_reduce(static_cast<std::int64_t>(solution.lines.count()), parallel::Reduce::sum) == 0) return;
  solution.lines.annotate({{"vessels", "1", static_cast<double>(solution.vessels)},
                           {"shown", "1", static_cast<double>(solution.shown)},
                           {"inflow", "m3/s", solution.inflow}});
  const auto fields = solution.lines.fields();
  output::LineSeriesPlan plan;
  plan.directory = folder.path();
  plan.title = c.title;
  plan.version = runtime::version();
  plan.fields.assign(fields.begin(), fields.end());
  plan.steps = {0};
  plan.precision = output::Precision::double_precision;
  plan.formats = output::formats_of(c.output);
  for (const std::string& name : output::series_files("network", plan.formats)) folder.claim(name);
  output::LineSeries(plan, solution.lines, comm).write(solution.lines);
  if (!c.network.vtp) return;
  parallel::together(comm, [&] {
    if (comm.is_root()) write_vtp(solution.lines, folder);
  });
}

}  // namespace

void write_network(const Configuration& c, NetworkSolution& solution, const output::ResultsFolder& folder,
                   parallel::Communicator comm) {
  write_tables(solution, folder, comm);
  write_lines(c, solution, folder, comm);
}

nlohmann::ordered_json to_json(const QueriedVessel& q) {
  nlohmann::ordered_json json{{"name", q.name},
                              {"vessel", q.vessel},
                              {"kind", kind_text(q.kind)},
                              {"generation", nullptr},
                              {"radius_m", q.radius},
                              {"length_m", q.length},
                              {"wall_thickness_m", q.wall_thickness},
                              {"strength_factor", q.strength_factor},
                              {"flow_m3_s", q.flow},
                              {"pressure_from_Pa", q.pressure_from},
                              {"pressure_to_Pa", q.pressure_to}};
  json["start_m"] = json["end_m"] = nullptr;
  if (q.generation >= 0) json["generation"] = q.generation;
  if (q.start) json["start_m"] = *q.start;
  if (q.end) json["end_m"] = *q.end;
  return json;
}

NetworkResults network_results(const NetworkSolution& solution) {
  NetworkResults n;
  n.vessels = solution.vessels;
  n.junctions = solution.junctions;
  n.inflow_m3_s = solution.inflow;
  n.max_imbalance = solution.max_imbalance;
  n.volume_m3 = solution.volume;
  n.surface_m2 = solution.surface;
  n.highest_reynolds = solution.highest_reynolds;
  n.highest_pressure_Pa = solution.highest_pressure;
  n.lowest_pressure_Pa = solution.lowest_pressure;
  n.solver = solution.solver;
  n.iterations = solution.iterations;
  n.queries = nlohmann::ordered_json::array();
  for (const QueriedVessel& q : solution.queries) n.queries.push_back(to_json(q));
  if (solution.screening) {
    auto list = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < solution.at_risk.size(); ++i) {
      const screening::RankedVessel& ranked = solution.screening->top[i];
      list.push_back({{"risk", ranked.risk}, {"alike", ranked.alike}});
      list.back().update(to_json(solution.at_risk[i]));
    }
    n.screening = {{"vessels", solution.screening->vessels},
                   {"above_limit", solution.screening->above},
                   {"top", std::move(list)}};
  }
  return n;
}

}  // namespace rhexis::app
