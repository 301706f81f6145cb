/// The ways to hold and solve a network, behind one interface: implicit tree, explicit graph, distributed
/// graph.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/configuration.hpp"
#include "hemodynamics/hydrostatic.hpp"
#include "hemodynamics/steady/tree/tree_flow.hpp"
#include "hemodynamics/steady/tree/tree_statistics.hpp"
#include "hemodynamics/steady/vessel_in_network.hpp"
#include "hemodynamics/vessel_lines.hpp"
#include "network/graph.hpp"
#include "network/tree_pair.hpp"
#include "parallel/communicator.hpp"
#include "studies/screening/screening.hpp"

namespace rhexis::app {

/// A vessel that the user asked for by name.
struct QueriedVessel {
  std::string name;  ///< as asked
  std::int64_t vessel = 0;
  network::VesselKind kind = network::VesselKind::unknown;
  int generation = -1;
  double radius = 0, length = 0, wall_thickness = 0;  ///< m
  double strength_factor = 1;                         ///< on the critical stretch of its wall
  double flow = 0;                                    ///< m3/s
  double pressure_from = 0, pressure_to = 0;          ///< Pa
  std::optional<std::array<double, 3>> start, end;    ///< m
};

/// A vessel of a table for the user (explicit networks).
struct VesselRow {
  std::string name, from, to;
  double radius, length, haematocrit, flow, pressure_from, pressure_to;
};

struct NetworkSolution {
  std::int64_t vessels = 0, junctions = 0;
  double inflow = 0;                                 ///< m3/s
  std::optional<double> max_imbalance;               ///< relative to the inflow
  std::optional<double> volume, surface;             ///< m3, m2
  double highest_pressure = 0, lowest_pressure = 0;  ///< Pa, of all junctions
  double highest_reynolds = 0;                       ///< number, of all vessels (a tree's: of its two roots)
  std::string solver;
  std::optional<std::int64_t> iterations, haematocrit_iterations;
  std::optional<double> flop;  ///< operations, where they are counted
  std::optional<hemodynamics::TreeStatistics> statistics;
  std::vector<QueriedVessel> queries;
  std::optional<screening::Screening> screening;
  std::vector<QueriedVessel> at_risk;  ///< [screening->top]
  std::vector<double> leaks;           ///< m3/s, of the injuries that earlier events left
  std::vector<VesselRow> table;
  /// Along each axis (m), of all vessels; none without coordinates.
  std::optional<std::array<std::pair<double, double>, 3>> extent;
  hemodynamics::VesselLines lines;  ///< to store and draw: this rank's
  std::int64_t shown = 0;           ///< of all ranks
  std::vector<std::string> warnings;
};

/// Says what is going on, at the terminal.
using Say = std::function<void(const std::string&)>;

/// "artery", "vein" or "vessel".
const char* kind_text(network::VesselKind kind);

class NetworkTier {
 public:
  virtual ~NetworkTier() = default;
  /// What the header says of the network.
  virtual std::string description() const = 0;
  /// Reads and checks everything that the user may have got wrong: throws InputError before anything is
  /// written.
  virtual void prepare() = 0;
  /// Throws RunError. Collective.
  virtual NetworkSolution solve(const Say& say) = 0;
  /// A vessel among `network.query` within the network that was solved; valid as long as this. Null on ranks
  /// that do not hold it (never on the first). Collective.
  virtual std::unique_ptr<hemodynamics::VesselInNetwork> vessel(const QueriedVessel& queried) = 0;
};

std::unique_ptr<NetworkTier> make_implicit_tier(const Configuration& c, parallel::Communicator comm);
std::unique_ptr<NetworkTier> make_explicit_tier(const Configuration& c, parallel::Communicator comm);
std::unique_ptr<NetworkTier> make_distributed_tier(const Configuration& c, parallel::Communicator comm);
/// What a vessel of a graph takes, coordinates and solver included (bytes); measured on a tree pair of 33.5
/// million vessels.
inline constexpr double bytes_per_vessel = 100;

/// By network.tier. Throws InputError, complete with place, for all that a user may have got wrong; trees
/// that are to be built are not yet. Collective.
std::unique_ptr<NetworkTier> checked_tier(const Configuration& c, parallel::Communicator comm);
/// The same, ready to be solved.
std::unique_ptr<NetworkTier> prepared_tier(const Configuration& c, parallel::Communicator comm);

/// What drives the flow of a tree: its boundary with pressures less the weight of blood at their places.
hemodynamics::TreeBoundary driving_boundary(const Configuration& c, const network::TreePair& tree,
                                            const hemodynamics::Hydrostatic& hydrostatic);

/// Warns where Eq. (9) does not hold, where nothing flows and where vessels would collapse; throws RunError
/// for a flow that is no number. `driving`, Pa: the lowest and highest pressure without the weight of blood.
void check_flow(NetworkSolution& s, const std::array<double, 2>& driving);

/// Walls of a tree are marked; of a file, the reader does that.
hemodynamics::VesselMechanics mechanics_of(const Configuration& c);
screening::Criterion criterion_of(const Configuration& c);

}  // namespace rhexis::app
