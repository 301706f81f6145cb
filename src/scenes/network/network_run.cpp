// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/network/network_run.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/stopwatch.hpp"
#include "scenes/folder_plan.hpp"
#include "scenes/network/flow_scene.hpp"
#include "scenes/pictures.hpp"

namespace rhexis::scenes {

NetworkRun::NetworkRun(Configuration configuration, runtime::RunOptions options, parallel::Communicator comm)
    : c_(std::move(configuration)),
      comm_(comm),
      session_(scene_of(c_), std::move(options), comm,
               {[this] { return output::Values(results_); },
                [this] { return runtime::Work{.network_flop = network_.flow().flop}; }}) {
  if (!session_.options().restart.empty())
    throw InputError("--restart is for scenes with a wall, scene.model = \"vessel\" or \"coupled\"");
}

runtime::Ending NetworkRun::run() {
  session_.open_folder(folder_plan(c_, session_.options()));
  solver_ = prepared_solver(c_, comm_);
  const runtime::Ending ending = session_.recorded([&] {
    session_.start_pictures();
    session_.open_record();
    print_header();
    solve();
    {
      const Stopwatch watch(session_.spent().output);
      studies::write_network(network_files_plan(c_), network_, session_.folder(), comm_);
    }
    draw();
    return 0;
  });
  print_summary();
  return ending;
}

void NetworkRun::solve() {
  const Stopwatch watch(session_.spent().solve);
  network_ = studies::solve_network(
      *solver_, flow_problem(c_), screening_plan(c_),
      [&](const std::string& text) { session_.console().line(text); }, comm_);
  session_.warn(network_.solution.warnings);
  results_.network = studies::network_record(&network_);
}

void NetworkRun::draw() {
  if (session_.pictures()->pipeline && network_.solution.display.shown > 0) {
    const Stopwatch watch(session_.spent().insitu);
    session_.pictures()->process({.particles = nullptr, .network = &network_.solution.display.lines});
  }
  session_.finish_pictures();
}

}  // namespace rhexis::scenes
