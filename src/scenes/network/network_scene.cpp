// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/network/network_scene.hpp"

#include "hemodynamics/vessel_lines.hpp"

namespace rhexis::scenes {

ParameterList declare(NetworkScene& s) {
  ParameterList all = declare_network(s.network);
  all.push_back(output::declare_format(s.output));
  append(all, insitu::declare(s.pictures.insitu));
  return all;
}

void resolve(NetworkScene& s, const Reading& reading) {
  resolve_network(s, s.network, reading.comm);
  warn_of_an_old_paraview(s, s.output.format);
  s.pictures.channels = {{"network", names_of(hemodynamics::VesselLines().fields())}};
  find_scripts(s, s.pictures, reading);
}

output::FolderPlan folder_plan(const NetworkScene& s, const runtime::RunOptions& options) {
  std::vector<std::string> reads = s.network.problem.network.files;
  append(reads, s.pictures.insitu.scripts);
  output::FolderPlan plan = plan_of_folder(s, options, reads);
  plan.writes.names = {"run.json"};
  append(plan.writes.names, studies::network_file_names(network_files_plan(s, s.network, s.output),
                                                        s.network.problem, s.network.screening.top > 0));
  return plan;
}

}  // namespace rhexis::scenes
