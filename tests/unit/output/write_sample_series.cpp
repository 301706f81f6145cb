// SPDX-License-Identifier: BSD-3-Clause
// Writes a small point series, with an unplanned last step, into a folder: what test_xdmf.py has ParaView
// read.
#include "output/point_series.hpp"
#include "synthetic_source.hpp"

int main(int argc, char** argv) {
  rhexis::parallel::Session session(argc, argv);
  if (argc != 3) return 2;
  const auto world = rhexis::parallel::Communicator::world();
  rhexis::test::SyntheticSource source(rhexis::test::divided(5, 7, world, 1), 0);
  rhexis::output::PointSeriesPlan plan{.directory = argv[1],
                                       .title = "sample",
                                       .version = "test",
                                       .fields = {source.fields().begin(), source.fields().end()},
                                       .annotations = {"pressure"},
                                       .steps = {0, 50, 100}};
  plan.formats = {rhexis::output::SeriesFormat::xdmf, rhexis::output::SeriesFormat::vtkhdf};
  if (argv[2] == std::string("double")) plan.precision = rhexis::Precision::double_precision;
  rhexis::output::PointSeries series(plan, source.ids(), world);
  for (const long step : {0, 50, 73}) {
    source.move_to(step);
    series.write(source);
  }
}
