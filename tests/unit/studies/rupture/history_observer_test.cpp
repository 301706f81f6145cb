// SPDX-License-Identifier: BSD-3-Clause
#include "studies/rupture/history_observer.hpp"

#include <gtest/gtest.h>

#include "core/text_file.hpp"
#include "peridynamics/simulation/time_loop.hpp"
#include "support/weak_vessel.hpp"
#include "unit/output/temporary_directory.hpp"

namespace rhexis::studies {
namespace {

TEST(HistoryObserver, AppendsARowAtEachOfItsStepsAndAtTheEnd) {
  const test::TemporaryDirectory directory;
  test::MadeVessel made;
  peridynamics::LoadSource load;
  const std::filesystem::path path = directory / "history.csv";
  const std::vector<long> steps = {0, 5};
  HistoryObserver history(made.simulation, load, {path, parallel::Communicator::world()}, steps);
  peridynamics::TimeLoop loop(made.simulation, load, {.steps = 8});
  loop.subscribe(history);
  loop.run();
  const std::string text = whole_file(path);
  EXPECT_NE(text.find("\n0,0,"), std::string::npos);
  EXPECT_NE(text.find("\n5,"), std::string::npos);
  EXPECT_NE(text.find("\n8,"), std::string::npos);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4);
}

}  // namespace
}  // namespace rhexis::studies
