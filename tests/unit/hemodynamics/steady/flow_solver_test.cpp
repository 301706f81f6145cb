// SPDX-License-Identifier: BSD-3-Clause
// One network by each of the solvers: they must tell the same of it.
#include "hemodynamics/steady/flow_solver.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "support/trees.hpp"

namespace rhexis::hemodynamics {
namespace {

constexpr double tolerance = 1e-8;  // of solvers, relative
const parallel::Communicator world = parallel::Communicator::world();
const Progress silent = [](const std::string&) {};

FlowProblem problem(network::Tier tier) {
  FlowProblem p;
  p.network.tier = tier;
  p.network.query = {"artery.010"};
  p.tree = test::random_rules(9);
  p.tree.artery_wall = p.network.wall.artery;
  p.tree.vein_wall = p.network.wall.vein;
  p.blood.viscosity = test::in_vivo();
  p.blood.inlet_pressure = 12600;
  p.blood.outlet_pressure = 600;
  return p;
}

class SolverOfTier : public testing::TestWithParam<network::Tier> {};

TEST_P(SolverOfTier, FindsTheFlowOfTheImplicitTree) {
  const auto reference = prepared_solver(problem(network::Tier::implicit_tree), world);
  const auto solver = prepared_solver(problem(GetParam()), world);
  EXPECT_EQ(solver->vessels(), reference->vessels());
  const NetworkSolution expected = reference->solve(silent, nullptr), found = solver->solve(silent, nullptr);
  const NetworkVessel exact = reference->vessel(5), vessel = solver->vessel(5);
  EXPECT_EQ(vessel.name, exact.name);
  EXPECT_EQ(vessel.kind, exact.kind);
  EXPECT_EQ(vessel.generation, exact.generation);
  EXPECT_NEAR(vessel.flow / exact.flow, 1, tolerance);
  EXPECT_NEAR(vessel.pressure_from / exact.pressure_from, 1, tolerance);
  EXPECT_NEAR(vessel.pressure_to / exact.pressure_to, 1, tolerance);
  EXPECT_NEAR(vessel.wall_thickness / exact.wall_thickness, 1, tolerance);
  ASSERT_TRUE(vessel.start && exact.start);
  if (!world.is_root()) return;  // a graph in memory is known to the first rank
  EXPECT_EQ(found.flow.vessels, expected.flow.vessels);
  EXPECT_NEAR(found.flow.inflow / expected.flow.inflow, 1, tolerance);
  ASSERT_EQ(found.queries.size(), 1u);
  EXPECT_EQ(found.queries[0].name, "artery.010");
  EXPECT_NEAR(found.queries[0].flow / expected.queries[0].flow, 1, tolerance);
}

INSTANTIATE_TEST_SUITE_P(Tiers, SolverOfTier,
                         testing::Values(network::Tier::explicit_graph, network::Tier::distributed_graph),
                         [](const auto& tier) { return std::string(name_of(tier.param)); });

TEST(FlowSolver, FindsVesselsByNameAndNamesTheKeyOfAnUnknownOne) {
  for (const network::Tier tier : {network::Tier::implicit_tree, network::Tier::explicit_graph}) {
    const auto solver = prepared_solver(problem(tier), world);
    const std::int64_t number = solver->find("vein.01", "coupling.vessel");
    solver->solve(silent, nullptr);
    EXPECT_EQ(solver->vessel(number).name, "vein.01");
    try {
      solver->find("vein.2", "coupling.vessel");
      ADD_FAILURE() << name_of(tier);
    } catch (const InputError& error) {
      EXPECT_EQ(error.key, "coupling.vessel");
    }
  }
}

TEST(FlowSolver, VisitsEveryVesselOnce) {
  struct Count : VesselVisitor {
    const char* name() const override { return "counting"; }
    VesselConsumer& consumer(int) override { throw RunError("no tree streams by"); }
    void visit(const network::Graph& graph, const GraphFlow& flow, const VesselMechanics&) override {
      vessels += graph.vessels();
      EXPECT_EQ(flow.flow.size(), graph.vessels());
    }
    std::size_t vessels = 0;
  };
  const auto solver = prepared_solver(problem(network::Tier::explicit_graph), world);
  Count count;
  solver->solve(silent, &count);
  const std::int64_t all = solver->vessels();
  EXPECT_EQ(count.vessels, world.is_root() ? static_cast<std::size_t>(all) : 0u);
}

TEST(NetworkVessel, IsKnownToAllRanksAfterABroadcast) {
  NetworkVessel vessel;
  if (world.is_root()) {
    vessel.name = "ICA";
    vessel.radius = 2e-3;
    vessel.start = {1, 2, 3};
  }
  const NetworkVessel everywhere = broadcast(world, vessel);
  EXPECT_EQ(everywhere.name, "ICA");
  EXPECT_EQ(everywhere.radius, 2e-3);
  ASSERT_TRUE(everywhere.start);
  EXPECT_EQ((*everywhere.start)[2], 3);
  EXPECT_FALSE(everywhere.end);
}

}  // namespace
}  // namespace rhexis::hemodynamics
