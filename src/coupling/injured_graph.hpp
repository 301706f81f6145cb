/// The steady flow in a graph some of whose vessels have ruptured: they bleed, or nothing flows through them
/// any more.
#pragma once

#include <cstdint>
#include <vector>

#include "coupling/bleeding.hpp"
#include "hemodynamics/graph_flow.hpp"
#include "network/graph.hpp"

namespace rhexis::coupling {

struct Injury {
  std::uint32_t vessel = 0;
  bool occluded = false;
  Orifice orifice = {};  ///< half way along the vessel, unless that is occluded
};

class InjuredGraph {
 public:
  /// Bleeding vessels are cut in two halves that meet at a new junction, after all others.
  /// `conductance` [V], m3/(s Pa).
  InjuredGraph(network::Graph graph, std::vector<double> conductance,
               std::vector<network::Condition> conditions, std::vector<Injury> injuries);

  struct Result {
    hemodynamics::GraphFlow flow;  ///< of the first J junctions and V vessels, those of the sound graph; a
                                   ///< bleeding vessel's flow is that at its `from` end
    std::vector<double> leaks;     ///< m3/s, of every injury
  };
  /// Leaks obey the orifice law; solved as resistances that are adjusted until they do, which halves the
  /// error at least each time. Throws RunError as solve_flow does.
  Result solve(const hemodynamics::GraphSolverOptions& options);

  /// With the leaks of the last solution as constant resistances.
  const network::Graph& graph() const { return graph_; }
  const std::vector<double>& conductance() const { return conductance_; }
  const std::vector<network::Condition>& conditions() const { return conditions_; }

 private:
  std::size_t junctions_, vessels_;  ///< of the sound graph
  network::Graph graph_;
  std::vector<double> conductance_;
  std::vector<network::Condition> conditions_;
  std::vector<Injury> injuries_;
  std::vector<std::size_t> condition_of_;  ///< [injuries]; none: occluded
};

}  // namespace rhexis::coupling
