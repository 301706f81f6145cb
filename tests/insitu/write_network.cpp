// SPDX-License-Identifier: BSD-3-Clause
// Stores a synthetic network as the solver would; test_insitu.py draws what is stored.
//   write_network DIRECTORY KIND       KIND as for insitu_driver, e.g. network:planar:4
#include "output/line_series.hpp"
#include "synthetic_network.hpp"

int main(int argc, char** argv) {
  rhexis::parallel::Session session(argc, argv);
  if (argc != 3) return 2;
  const auto world = rhexis::parallel::Communicator::world();
  rhexis::test::SyntheticNetwork network(argv[2], world.rank(), world.size());
  rhexis::output::LineSeries series({.directory = argv[1],
                                     .title = "synthetic",
                                     .version = "test",
                                     .fields = {network.fields().begin(), network.fields().end()},
                                     .steps = {0, 50}},
                                    network, world);
  for (const long step : {0, 50}) {
    network.advance(step, step == 0 ? 0 : 1);
    series.write(network);
  }
}
