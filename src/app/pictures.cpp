#include "app/pictures.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

#include "app/configuration.hpp"
#include "core/installation.hpp"
#include "hemodynamics/vessel_lines.hpp"
#include "input/wording.hpp"
#include "parallel/together.hpp"
#include "peridynamics/monitors/particle_source.hpp"

namespace rhexis::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* key = "insitu.scripts";

insitu::Renderer renderer(const std::string& name) {
  if (name == "osmesa") return insitu::Renderer::osmesa;
  if (name == "egl") return insitu::Renderer::egl;
  if (name == "x11") return insitu::Renderer::x11;
  return insitu::Renderer::automatic;
}

std::vector<std::string> names_of(std::span<const FieldInfo> fields) {
  std::vector<std::string> names;
  for (const FieldInfo& field : fields) names.emplace_back(field.name);
  return names;
}

insitu::Settings settings_for(const Configuration& c) {
  insitu::Settings settings;
  settings.scripts = c.insitu.scripts;
  settings.renderer = renderer(c.insitu.renderer);
  if (c.model != "network") settings.particle_fields = names_of(peridynamics::ParticleSource::all_fields());
  if (c.model != "vessel") settings.network_fields = names_of(hemodynamics::VesselLines().fields());
  settings.live = c.insitu.live;
  // A run that is watched may be paused.
  settings.time_limit_s =
      c.insitu.live.empty() ? c.insitu.time_limit : std::numeric_limits<double>::infinity();
  return settings;
}

fs::path own_scripts() {
  return installation_prefix() / data_folder / "catalyst_scripts";
}

bool is_package(const fs::path& path) {
  return fs::exists(path / "__init__.py");
}

/// Of a plain name, e.g. "vessel".
fs::path own_script(const std::string& name) {
  const fs::path folder = own_scripts();
  std::vector<std::string> known;
  for (const char* script : {"coupled", "network", "template", "vessel"})
    if (fs::exists(folder / (std::string(script) + ".py"))) known.emplace_back(script);
  if (std::ranges::find(known, name) != known.end()) return folder / (name + ".py");
  if (known.empty()) throw InputError("Rhexis's own scripts are not in " + folder.string(), key);
  throw InputError("there is no script of this name; there are " + input::quoted_list(known) +
                       input::did_you_mean(input::closest(name, known)) +
                       "; a path says where one of yours is, " + input::in_quotes("./" + name + ".py"),
                   key);
}

/// A path is looked for from the working folder first (what is typed at the terminal), then from the input
/// file's folder (what an input file says of its neighbours).
fs::path find_script(const std::string& script, const fs::path& input_folder) {
  const fs::path here = script, beside = input_folder / script;
  const bool plain = here.filename() == here && !here.has_extension();
  for (const fs::path& path : {here, beside})
    if (plain ? is_package(path) : fs::exists(path)) return path;
  if (plain) return own_script(script);
  const std::string first = fs::absolute(here).lexically_normal().string(),
                    second = fs::absolute(beside).lexically_normal().string();
  throw InputError("there is no Catalyst script " + first + (first == second ? "" : " or " + second), key);
}

void check_address(const std::string& live) {
  const std::size_t colon = live.rfind(':');
  unsigned port = 0;
  const char* end = live.data() + live.size();
  const bool is_address = colon != std::string::npos && colon > 0 &&
                          std::from_chars(live.data() + colon + 1, end, port).ptr == end && port >= 1 &&
                          port <= 65535;
  if (!live.empty() && !is_address)
    throw InputError("must be host:port with a port from 1 to 65535, e.g. \"localhost:22222\"",
                     "insitu.live");
}

}  // namespace

void find_scripts(Configuration& c, parallel::Communicator comm) {
  if (!c.insitu.enabled || c.insitu.scripts.empty()) return;
  check_address(c.insitu.live);
  for (std::string& script : c.insitu.scripts) {
    std::string found;
    // By the root rank, for ranks may see other files.
    parallel::on_root<InputError>(comm, [&] {
      const fs::path path = fs::canonical(find_script(script, fs::path(c.file).parent_path()));
      if (path.extension() != ".py" && !is_package(path))
        throw InputError(path.string() + " is no Python file (.py), nor a folder with __init__.py", key);
      found = path.string();
    });
    script = comm.broadcast(found);
  }
  try {
    c.no_pictures = insitu::inspect_scripts(settings_for(c), comm);
  } catch (const InputError& error) {
    throw InputError(error.what(), key);
  }
}

void Pictures::process(const insitu::Channels& channels) {
  staging->open();
  pipeline->process(channels);
}

Pictures start_pictures(const Configuration& c, const output::ResultsFolder& results,
                        parallel::Communicator comm, std::function<void(const std::string&)> before_abort) {
  Pictures pictures;
  if (!c.insitu.enabled) {
    pictures.description = "off (insitu.enabled = false)";
  } else if (c.insitu.scripts.empty()) {
    pictures.description = "off (no insitu.scripts)";
  } else if (!c.no_pictures.empty()) {
    pictures.description = "off: " + c.no_pictures;
  }
  if (!pictures.description.empty()) return pictures;
  auto staging = std::make_unique<output::StagingFolder>(results, "images", comm);
  insitu::Settings settings = settings_for(c);
  settings.image_directory = staging->path().string();
  settings.after_script = [to = staging.get()](const std::string& script, long step) {
    to->deliver("Catalyst script " + script, step);
  };
  settings.before_abort = std::move(before_abort);
  try {
    pictures.pipeline = insitu::load_pipeline(settings, comm);
    pictures.description = pictures.pipeline->description();
    pictures.staging = std::move(staging);
  } catch (const insitu::NotAvailable& reason) {
    pictures.description = std::string("off: ") + reason.what();
  } catch (const RunError& bad_script) {
    throw InputError(bad_script.what());
  }
  return pictures;
}

}  // namespace rhexis::app
