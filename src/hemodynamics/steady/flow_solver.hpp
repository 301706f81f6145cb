// SPDX-License-Identifier: BSD-3-Clause
/// The ways to hold a network and find its steady flow, behind one interface: a tree pair by recursion, of
/// which nothing is stored; a graph in memory; a graph over the memory of all ranks.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hemodynamics/steady/flow_problem.hpp"
#include "hemodynamics/steady/tree/tree_statistics.hpp"
#include "hemodynamics/steady/vessel_in_network.hpp"
#include "hemodynamics/vessel_lines.hpp"
#include "network/survey/network_survey.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::hemodynamics {

/// A cross-section of a vessel, m.
struct VesselSection {
  double radius = 0, wall_thickness = 0;
};

/// All of a vessel but its name.
struct VesselProperties {
  std::int64_t vessel = 0;  ///< id in a tree, number in a graph
  network::VesselKind kind = network::VesselKind::unknown;
  int generation = -1;                                   ///< -1: unknown
  double radius = 0, length = 0, wall_thickness = 0;     ///< m
  std::optional<std::array<VesselSection, 2>> sections;  ///< narrowest and widest, if radii vary along it
  bool wall_is_given = false;                 ///< its thickness by the file or [[wall_range]]; else by [wall]
  double strength_factor = 1;                 ///< on the critical stretch of its wall
  double flow = 0;                            ///< m3/s, along the vessel
  double pressure_from = 0, pressure_to = 0;  ///< Pa, at its ends, with the weight of blood
  std::optional<std::array<double, 3>> start, end;  ///< m
};

/// A vessel of a network that has been solved.
struct NetworkVessel : VesselProperties {
  std::string name;
};

/// The vessel that `root` knows on every rank. Collective.
NetworkVessel broadcast(parallel::Communicator comm, const NetworkVessel& vessel, int root = 0);

/// A row of the table of all vessels; SI units.
struct VesselTableRow {
  std::string name, from, to;
  double radius, length, haematocrit, flow, pressure_from, pressure_to;
};

/// The flow in numbers; on all ranks, but of a graph in memory on the first rank only.
struct NetworkFlow {
  std::int64_t vessels = 0, junctions = 0;
  double inflow = 0;                                 ///< m3/s
  std::optional<double> max_imbalance;               ///< relative to the inflow
  std::optional<double> volume, surface;             ///< m3, m2, of the lumens
  double highest_pressure = 0, lowest_pressure = 0;  ///< Pa, of all junctions
  double highest_reynolds = 0;                       ///< number, of all vessels (a tree's: of its two roots)
  std::string solver;
  std::optional<std::int64_t> iterations;
  std::optional<std::int64_t> haematocrit_iterations;  ///< to the fixed point; none: it was not reached
  std::optional<double> flop;                          ///< operations, where they are counted
  std::vector<double> leaks;                           ///< m3/s, of FlowProblem::failures
};

/// What is stored and drawn of a network.
struct NetworkDisplay {
  VesselLines lines;       ///< vessels that this rank shows
  std::int64_t shown = 0;  ///< vessels, of all ranks
  /// Along each axis (m), of all vessels; none without coordinates.
  std::optional<std::array<std::pair<double, double>, 3>> extent;
};

struct NetworkSolution {
  NetworkFlow flow;
  std::optional<TreeStatistics> statistics;
  std::vector<NetworkVessel> queries;  ///< the vessels of network.query
  std::vector<VesselTableRow> table;   ///< all vessels of a graph that is small enough
  NetworkDisplay display;
  std::optional<network::NetworkSurvey> survey;  ///< of a network from files, on the first rank
  std::vector<std::string> warnings;
};

/// Told, in a line of text, what has been done and how long it took.
using Progress = std::function<void(const std::string&)>;

/// Looks at every vessel of a network when its flow is known: a study that needs no network stored.
class VesselVisitor {
 public:
  virtual ~VesselVisitor() = default;
  /// What it does, for Progress: "screening".
  virtual const char* name() const = 0;
  /// Takes the vessels of a tree that stream by on this thread.
  virtual VesselConsumer& consumer(int thread) = 0;
  /// Takes all vessels of a graph, on the rank that holds it; pressures contain the weight of blood.
  virtual void visit(const network::Graph& graph, const GraphFlow& flow,
                     const VesselMechanics& mechanics) = 0;
};

/// After the constructor: `prepare`, `solve`, and then what asks for the solution.
class FlowSolver {
 public:
  virtual ~FlowSolver() = default;
  /// What the header says of the network.
  virtual std::string description() const = 0;
  /// Reads and checks everything that the user may have got wrong: throws InputError before anything is
  /// written. Collective.
  virtual void prepare() = 0;
  /// How many vessels the prepared network has. Collective.
  virtual std::int64_t vessels() const = 0;
  /// What the prepared network is like. Null where it is a tree, and on ranks other than the first.
  virtual const network::NetworkSurvey* survey() const { return nullptr; }
  /// The vessel of a name in a file, of an id or path in a tree. Throws InputError, of `key`, where there is
  /// none. Collective.
  virtual std::int64_t find(const std::string& name, const std::string& key) const = 0;
  /// `visitor`: null, or what looks at every vessel. Throws RunError. Collective.
  virtual NetworkSolution solve(const Progress& progress, VesselVisitor* visitor) = 0;
  /// A vessel of the solution by its number, named as the network names it. Collective.
  virtual NetworkVessel vessel(std::int64_t number) const = 0;
  /// The same within the network around it; valid as long as this. Null on ranks that do not hold the network
  /// (never on the first). Collective.
  virtual std::unique_ptr<VesselInNetwork> vessel_in_network(std::int64_t number) const = 0;
};

std::unique_ptr<FlowSolver> make_implicit_solver(FlowProblem problem, parallel::Communicator comm);
std::unique_ptr<FlowSolver> make_explicit_solver(FlowProblem problem, parallel::Communicator comm);
std::unique_ptr<FlowSolver> make_distributed_solver(FlowProblem problem, parallel::Communicator comm);

/// Memory that a vessel of a graph takes, coordinates and solver included (bytes); measured on a tree pair of
/// 33.5 million vessels.
inline constexpr double bytes_per_vessel = 100;

/// The solver of network.tier, prepared, ready to solve. Throws InputError for all that a user may have got
/// wrong. Collective.
std::unique_ptr<FlowSolver> prepared_solver(const FlowProblem& problem, parallel::Communicator comm);
/// The same, but a tree that is to be held in memory is only checked to fit there: what description() needs.
std::unique_ptr<FlowSolver> checked_solver(const FlowProblem& problem, parallel::Communicator comm);

/// Warns where Eq. (9) does not hold, where nothing flows and where vessels would collapse; throws RunError
/// for a flow that is no number. `driving`, Pa: the lowest and highest pressure without the weight of blood.
void check_flow(NetworkSolution& solution, const std::array<double, 2>& driving);

}  // namespace rhexis::hemodynamics
