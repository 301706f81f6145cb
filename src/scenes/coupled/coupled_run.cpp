// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/coupled/coupled_run.hpp"

#include <utility>

#include "runtime/run_session.hpp"
#include "scenes/coupled/cascade_run.hpp"
#include "scenes/coupled/coupled_files.hpp"
#include "scenes/coupled/network_coupling.hpp"
#include "scenes/vessel/vessel_run.hpp"

namespace rhexis::scenes {

runtime::Ending run(CoupledScene scene, const runtime::RunOptions& options, parallel::Communicator comm) {
  if (scene.is_cascade()) return run_cascade(std::move(scene), options, comm);
  runtime::Console console(comm.is_root(), options.quiet);
  runtime::print_title(console, scene.title, scene.file);
  runtime::RunOptions with_folder = options;
  with_folder.folder.emplace(folder_plan(scene, options), comm);
  NetworkCoupling coupling(scene, nullptr, reading_for_a_run(comm, console), console);
  return VesselRun(coupling.make_vessel(), with_folder, comm, &coupling).run();
}

}  // namespace rhexis::scenes
