#include "app/network_run.hpp"

#include <fmt/format.h>

#include "app/network_tables.hpp"
#include "app/stopwatch.hpp"
#include "app/version.hpp"
#include "core/error.hpp"
#include "network/vtp_network.hpp"
#include "output/atomic_file.hpp"
#include "output/line_series.hpp"
#include "parallel/together.hpp"

namespace rhexis::app {

NetworkRun::NetworkRun(Configuration configuration, RunOptions options, parallel::Communicator comm)
    : RunBase(std::move(configuration), std::move(options), comm) {
  if (!options_.restart.empty()) throw InputError("--restart is for scenes with scene.model = \"vessel\"");
}

Ending NetworkRun::run() {
  tier_ = make_tier(c_, comm_);
  tier_->prepare();
  try {
    open_directory(output::EarlierResults::remove);
    open_record();
    start_insitu();
    say_header();
    solve();
    {
      const Stopwatch watch(spent_.output);
      write_tables();
      write_lines();
    }
    draw();
  } catch (const RunError& error) {
    note_failure(error.what());
    throw;
  }
  record_->complete(results_, performance());
  say_summary();
  return Ending::completed;
}

void NetworkRun::solve() {
  const Stopwatch watch(spent_.solve);
  solution_ = tier_->solve([&](const std::string& text) { console_.line(text); });
  output::NetworkResults& n = results_.network;
  n.vessels = solution_.vessels;
  n.junctions = solution_.junctions;
  n.inflow_m3_s = solution_.inflow;
  n.max_imbalance = solution_.max_imbalance;
  n.volume_m3 = solution_.volume;
  n.surface_m2 = solution_.surface;
  n.highest_pressure_Pa = solution_.highest_pressure;
  n.lowest_pressure_Pa = solution_.lowest_pressure;
  n.solver = solution_.solver;
  n.iterations = solution_.iterations;
  n.queries = nlohmann::ordered_json::array();
  for (const QueriedVessel& q : solution_.queries) n.queries.push_back(to_json(q));
}

void NetworkRun::write_tables() {
  parallel::on_root<RunError>(comm_, [&] {
    if (solution_.statistics) {
      output::write_atomically(options_.directory / "generations.csv",
                               generation_table(*solution_.statistics));
      output::write_atomically(options_.directory / "histograms.csv", histogram_table(*solution_.statistics));
    }
    if (!solution_.table.empty()) {
      output::write_atomically(options_.directory / "vessels.csv", vessel_table(solution_.table));
    }
  });
}

void NetworkRun::write_lines() {
  if (comm_.all_reduce(static_cast<std::int64_t>(solution_.lines.count()), parallel::Reduce::sum) == 0)
    return;
  solution_.lines.annotate({{"vessels", "1", static_cast<double>(solution_.vessels)},
                            {"shown", "1", static_cast<double>(solution_.shown)},
                            {"inflow", "m3/s", solution_.inflow}});
  const auto fields = solution_.lines.fields();
  output::LineSeriesPlan plan;
  plan.directory = options_.directory;
  plan.title = c_.title;
  plan.version = version();
  plan.fields.assign(fields.begin(), fields.end());
  plan.steps = {0};
  plan.precision = output::Precision::double_precision;
  output::LineSeries(plan, solution_.lines, comm_).write(solution_.lines);
  if (c_.network.vtp) parallel::on_root<RunError>(comm_, [&] { write_vtp(); });
}

/// The first rank's lines, which are all but of a distributed network.
void NetworkRun::write_vtp() {
  hemodynamics::VesselLines& lines = solution_.lines;
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
  network::write_vtp_network(options_.directory / "network.vtp", graph, points, cells);
}

void NetworkRun::draw() {
  if (!pipeline_) return;
  const Stopwatch watch(spent_.insitu);
  pipeline_->process({.particles = nullptr, .network = &solution_.lines});
  pipeline_->finish();
}

}  // namespace rhexis::app
