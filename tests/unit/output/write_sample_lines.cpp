// SPDX-License-Identifier: BSD-3-Clause
// Writes a small line series, with an unplanned last step, into a folder: what test_xdmf.py has ParaView
// read.
#include "output/line_series.hpp"
#include "synthetic_lines.hpp"

int main(int argc, char** argv) {
  rhexis::parallel::Session session(argc, argv);
  if (argc != 3) return 2;
  const auto world = rhexis::parallel::Communicator::world();
  rhexis::test::SyntheticLines source(13, world, 0);
  rhexis::output::LineSeriesPlan plan{.directory = argv[1],
                                      .title = "sample",
                                      .version = "test",
                                      .fields = {source.fields().begin(), source.fields().end()},
                                      .steps = {0, 50, 100}};
  plan.formats = {rhexis::output::SeriesFormat::xdmf, rhexis::output::SeriesFormat::vtkhdf};
  if (argv[2] == std::string("double")) plan.precision = rhexis::Precision::double_precision;
  rhexis::output::LineSeries series(plan, source, world);
  for (const long step : {0, 50, 73}) {
    source.move_to(step);
    series.write(source);
  }
}
