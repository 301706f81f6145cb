#include "app/configuration.hpp"

#include <cmath>
#include <filesystem>

#include "core/error.hpp"
#include "core/format.hpp"
#include "input/document.hpp"
#include "input/reader.hpp"
#include "peridynamics/bond_family.hpp"
#include "peridynamics/cross_section.hpp"
#include "peridynamics/materials/pmb.hpp"
#include "peridynamics/particle_source.hpp"
#include "peridynamics/pressure_layer.hpp"

namespace rhexis::app {
namespace {

std::string read_on_root(const std::string& file, parallel::Communicator comm) {
  std::string text, error;
  if (comm.is_root()) {
    try {
      text = input::read_text(file);
    } catch (const InputError& e) {
      error = e.what();
    }
  }
  error = comm.broadcast(error);
  if (!error.empty()) throw InputError(error);
  return comm.broadcast(text);
}

/// The stable time step, and the one to take: the user's, or a share of the stable one that divides the end
/// time evenly.
void settle_time_step(Configuration& c) {
  const peridynamics::Lattice lattice = peridynamics::make_lattice(c.vessel);
  peridynamics::make_pressure_layer(c.vessel, lattice);  // throws where no particle would be loaded
  c.stable_time_step = peridynamics::stable_time_step(
      lattice, peridynamics::make_families(lattice),
      peridynamics::Pmb::bond_constant(c.vessel.young_modulus, *c.vessel.horizon), c.vessel.density);
  c.time_step = c.vessel.time_step.value_or(c.vessel.step_fraction * c.stable_time_step);
  if (c.time_step > c.stable_time_step) {
    throw InputError("the run would be unstable; the largest stable time step of this discretisation is " +
                         quantity(0.9995 * c.stable_time_step, "s", 3) + "; take less, or \"auto\" for " +
                         quantity(c.vessel.step_fraction * c.stable_time_step, "s"),
                     "time.step");
  }
  const double steps = c.vessel.end_time / c.time_step;
  if (steps > 1e12) throw InputError("the run would take " + text(steps) + " steps", "time.end");
  c.steps = std::max(1L, static_cast<long>(std::ceil(steps - 1e-6)));
  if (!c.vessel.time_step) {
    c.time_step = c.vessel.end_time / static_cast<double>(c.steps);
  } else if (std::abs(steps - static_cast<double>(c.steps)) > 1e-3) {
    c.warnings.push_back("time.end is not a whole number of steps; the run ends at " +
                         quantity(static_cast<double>(c.steps) * c.time_step, "s", 6));
  }
}

/// Scripts are looked for from the working folder first (what is typed at the terminal), then from the input
/// file's folder (what an input file says of its neighbours); by the root rank, for ranks may see other
/// files.
void resolve_scripts(Configuration& c, parallel::Communicator comm) {
  namespace fs = std::filesystem;
  for (std::string& script : c.insitu.scripts) {
    std::string found, error;
    if (comm.is_root()) {
      const fs::path beside = fs::path(c.file).parent_path() / script;
      if (fs::exists(script)) {
        found = fs::canonical(script).string();
      } else if (fs::exists(beside)) {
        found = fs::canonical(beside).string();
      } else {
        error = "there is no Catalyst script " + fs::absolute(script).lexically_normal().string() + " or " +
                fs::absolute(beside).lexically_normal().string();
      }
    }
    error = comm.broadcast(error);
    if (!error.empty()) throw InputError(error, "insitu.scripts");
    script = comm.broadcast(found);
  }
}

}  // namespace

ParameterList declare(Configuration& c) {
  ParameterList all{
      {"scene.title", &c.title, "", "\"\"", "What the run shows; stored with the results.", ""}};
  std::vector<std::string> fields;
  for (const FieldInfo& field : peridynamics::ParticleSource::all_fields()) fields.emplace_back(field.name);
  for (const ParameterList& part :
       {peridynamics::declare(c.vessel), output::declare(c.output, fields), insitu::declare(c.insitu)}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

Configuration read_configuration(const std::string& file, const std::vector<std::string>& overrides,
                                 parallel::Communicator comm) {
  Configuration c;
  c.file = file;
  const input::Document document = input::parse_document(read_on_root(file, comm), file, overrides);
  const input::Resolved resolved = input::read(document, declare(c));
  try {
    c.warnings = peridynamics::resolve(c.vessel);
    settle_time_step(c);
    c.output_steps = output::planned_steps(c.output, c.steps, c.time_step);
    if (c.insitu.enabled) resolve_scripts(c, comm);
  } catch (const InputError& error) {
    throw input::located(error, resolved);
  }
  c.record = input::to_json(resolved);
  return c;
}

}  // namespace rhexis::app
