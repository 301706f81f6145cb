// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/pictures.hpp"

#include "hemodynamics/vessel_lines.hpp"
#include "peridynamics/monitors/particle_source.hpp"

namespace rhexis::scenes {
namespace {

std::vector<std::string> names_of(std::span<const FieldInfo> fields) {
  std::vector<std::string> names;
  for (const FieldInfo& field : fields) names.emplace_back(field.name);
  return names;
}

}  // namespace

runtime::PicturesPlan pictures_plan(const Configuration& c) {
  runtime::PicturesPlan plan{.insitu = c.insitu, .obstacle = c.no_pictures};
  if (c.model != Model::network) plan.particle_fields = names_of(peridynamics::ParticleSource::all_fields());
  if (c.model != Model::vessel) plan.network_fields = names_of(hemodynamics::VesselLines().fields());
  return plan;
}

runtime::Scene scene_of(const Configuration& c) {
  return {.file = c.file,
          .title = c.title,
          .input = c.record,
          .pictures = pictures_plan(c),
          .movie = c.output.movie,
          .frames_per_second = c.output.frames_per_second};
}

void find_scripts(Configuration& c, parallel::Communicator comm) {
  runtime::PicturesPlan plan = pictures_plan(c);
  runtime::find_scripts(plan, c.file, comm);
  c.insitu.scripts = plan.insitu.scripts;
  c.no_pictures = plan.obstacle;
}

}  // namespace rhexis::scenes
