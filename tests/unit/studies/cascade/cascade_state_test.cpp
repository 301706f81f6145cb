// SPDX-License-Identifier: BSD-3-Clause
// The state of a cascade: what events add to it, its table, and that a checkpoint holds all of it.
#include "studies/cascade/cascade_state.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "unit/output/temporary_directory.hpp"

namespace rhexis::studies {
namespace {

/// Two events: one that ruptured, with a comma in its vessel's name, and one that an interrupt ended.
CascadeState two_events() {
  CascadeState state;
  CascadeEvent torn{.vessel = {},
                    .risk = 1.5,
                    .net_pressure = 2e4,
                    .ruptured = true,
                    .time = 0.1 + 0.2,
                    .rupture_onset = 1e-3,
                    .opening = 1e-6,
                    .inflow_before = 1e-5,
                    .inflow_after = 1.1e-5,
                    .leak = 1e-6,
                    .next_vessel = "b",
                    .next_risk = 1.2};
  torn.vessel.name = "a, left";
  torn.vessel.vessel = 7;
  torn.vessel.kind = network::VesselKind::vein;
  torn.vessel.generation = 3;
  torn.vessel.radius = 1e-3;
  torn.vessel.start = {0, -1, 2};
  torn.vessel.end = {0, 1, 2};
  state.record(torn, hemodynamics::VesselFailure{7, false, {2e-6, 133}}, 4e-3, 1001);
  CascadeEvent interrupted{.vessel = {}, .risk = 1.2};
  interrupted.vessel.name = "b";
  interrupted.vessel.vessel = 2;
  state.record(interrupted, {}, 1e-3, 251);
  return state;
}

TEST(CascadeState, AddsUpItsEvents) {
  const CascadeState state = two_events();
  EXPECT_EQ(state.simulated, (std::vector<std::uint32_t>{7, 2}));
  ASSERT_EQ(state.failures.size(), 1u);
  EXPECT_EQ(state.failures.front().vessel, 7u);
  EXPECT_DOUBLE_EQ(state.elapsed, 5e-3);
  EXPECT_EQ(state.steps_before, 1252);
}

TEST(CascadeTable, HasARowForEachEventAndQuotesNames) {
  const std::string table = cascade_table(two_events().events);
  EXPECT_NE(table.find("\n1,0.30000000000000004,\"a, left\",vein,3,1.5,true,0.001,"), std::string::npos)
      << table;
  EXPECT_NE(table.find("\n2,,b,vessel,,1.2,,,"), std::string::npos) << table;
}

CascadeState stored_and_read(const CascadeState& state) {
  const auto world = parallel::Communicator::world();
  const test::TemporaryDirectory folder;
  output::CheckpointWriter writer(folder / "cascade.h5", "test", world);
  save_cascade(state, world, writer);
  writer.close();
  output::CheckpointReader reader(folder / "cascade.h5", world);
  EXPECT_TRUE(reader.holds(cascade_name));
  return read_cascade(reader);
}

TEST(CascadeCheckpoint, HoldsTheWholeState) {
  const CascadeState state = two_events(), read = stored_and_read(state);
  ASSERT_EQ(read.events.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(to_json(read.events[i], i + 1), to_json(state.events[i], i + 1));
  EXPECT_FALSE(read.events[1].ruptured.has_value());
  EXPECT_EQ(read.simulated, state.simulated);
  ASSERT_EQ(read.failures.size(), 1u);
  EXPECT_EQ(read.failures[0].vessel, 7u);
  EXPECT_FALSE(read.failures[0].occluded);
  EXPECT_EQ(read.failures[0].orifice.strength, 2e-6);
  EXPECT_EQ(read.failures[0].orifice.outside_pressure, 133);
  EXPECT_EQ(read.elapsed, state.elapsed);
  EXPECT_EQ(read.steps_before, state.steps_before);
}

TEST(CascadeCheckpoint, OfTheFirstEventHoldsNone) {
  const CascadeState read = stored_and_read({});
  EXPECT_TRUE(read.events.empty());
  EXPECT_TRUE(read.failures.empty());
}

TEST(CascadeCheckpoint, WithNumbersThatMakeNoSenseIsRefused) {
  CascadeState state = two_events();
  state.events[0].opening = -1;
  EXPECT_THROW(stored_and_read(state), InputError);
}

}  // namespace
}  // namespace rhexis::studies
