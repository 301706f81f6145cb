#include "app/network_run.hpp"

#include <fmt/format.h>

#include "app/network_files.hpp"
#include "app/stopwatch.hpp"
#include "core/error.hpp"

namespace rhexis::app {

NetworkRun::NetworkRun(Configuration configuration, RunOptions options, parallel::Communicator comm)
    : RunBase(std::move(configuration), std::move(options), comm) {
  if (!options_.restart.empty())
    throw InputError("--restart is for scenes with a wall, scene.model = \"vessel\" or \"coupled\"");
}

Ending NetworkRun::run() {
  open_folder();
  tier_ = prepared_tier(c_, comm_);
  const Ending ending = recorded([&] {
    start_insitu();
    open_record();
    say_header();
    solve();
    {
      const Stopwatch watch(spent_.output);
      write_network(c_, solution_, *folder_, comm_);
    }
    draw();
    return 0;
  });
  say_summary();
  return ending;
}

void NetworkRun::solve() {
  const Stopwatch watch(spent_.solve);
  solution_ = tier_->solve([&](const std::string& text) { console_.line(text); });
  for (const std::string& warning : solution_.warnings) warn(warning);
  results_.network = network_results(solution_);
}

void NetworkRun::draw() {
  if (pictures_->pipeline && solution_.shown > 0) {
    const Stopwatch watch(spent_.insitu);
    pictures_->process({.particles = nullptr, .network = &solution_.lines});
  }
  finish_insitu();
}

}  // namespace rhexis::app
