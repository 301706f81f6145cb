// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/network/network_run.hpp"

#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/stopwatch.hpp"
#include "runtime/run_session.hpp"
#include "scenes/network/network_report.hpp"
#include "scenes/results.hpp"
#include "studies/flow/solved_network.hpp"

namespace rhexis::scenes {
namespace {

class NetworkRun {
 public:
  NetworkRun(NetworkScene scene, const runtime::RunOptions& options, parallel::Communicator comm)
      : scene_(std::move(scene)),
        comm_(comm),
        session_(describe(scene_, scene_.pictures, scene_.output), options, comm,
                 {[this] { return output::Values(results_); },
                  [this] { return runtime::Work{.network_flop = network_.flow().flop}; }}) {
    if (session_.restarts())
      throw InputError("--restart is for scenes with a wall, scene.model = \"vessel\" or \"coupled\"");
  }

  runtime::Ending run() {
    session_.open_folder(folder_plan(scene_, session_.options()));
    solver_ =
        with_place(scene_, [&] { return hemodynamics::prepared_solver(scene_.network.problem, comm_); });
    const runtime::Ending ending = session_.recorded([&] {
      session_.start_pictures();
      session_.open_record();
      print_header();
      solve();
      store();
      show();
      return 0;
    });
    session_.console().line("Done.");
    print_solution(session_.console(), network_);
    session_.print_cost(session_.performance());
    return ending;
  }

 private:
  void print_header() {
    session_.print_title();
    session_.warn(scene_.warnings);
    session_.warn(warnings_of(*solver_));
    print_network(session_.console(), *solver_, scene_.network.problem.blood);
    session_.print_surroundings();
  }

  void solve() {
    const Stopwatch watch(session_.spent().solve);
    network_ = studies::solve_network(
        *solver_, scene_.network.problem, screening_plan(scene_.network),
        [&](const std::string& text) { session_.console().line(text); }, comm_);
    session_.warn(network_.solution.warnings);
    results_.network = studies::network_record(&network_);
  }

  void store() {
    const Stopwatch watch(session_.spent().output);
    studies::write_network(network_files_plan(scene_, scene_.network, scene_.output), network_,
                           session_.folder(), comm_);
  }

  void show() {
    if (network_.solution.display.shown > 0) {
      const insitu::Channels channels{{"network", &network_.solution.display.lines}};
      if (session_.options().on_output) session_.options().on_output(channels);
      const Stopwatch watch(session_.spent().insitu);
      if (session_.pictures()->pipeline) session_.pictures()->process(0, 0, channels);
    }
    session_.finish_pictures();
  }

  NetworkScene scene_;
  parallel::Communicator comm_;
  Results results_;
  runtime::RunSession session_;
  std::unique_ptr<hemodynamics::FlowSolver> solver_;
  studies::SolvedNetwork network_;
};

}  // namespace

runtime::Ending run(NetworkScene scene, const runtime::RunOptions& options, parallel::Communicator comm) {
  return NetworkRun(std::move(scene), options, comm).run();
}

}  // namespace rhexis::scenes
