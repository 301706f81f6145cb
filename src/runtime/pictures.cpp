// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/pictures.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

#include "core/error.hpp"
#include "core/installation.hpp"
#include "input/wording.hpp"
#include "parallel/together.hpp"

namespace rhexis::runtime {
namespace {

namespace fs = std::filesystem;

constexpr const char* key = "insitu.scripts";

insitu::Settings settings_for(const PicturesPlan& plan) {
  insitu::Settings settings;
  settings.scripts = plan.insitu.scripts;
  settings.renderer = plan.insitu.renderer;
  settings.channels = plan.channels;
  settings.live = plan.insitu.live;
  // A run that is watched may be paused.
  settings.time_limit_s =
      plan.insitu.live.empty() ? plan.insitu.time_limit : std::numeric_limits<double>::infinity();
  return settings;
}

bool is_package(const fs::path& path) {
  return fs::exists(path / "__init__.py");
}

/// The script that a plain name, e.g. "vessel", stands for.
fs::path own_script(const std::string& name) {
  const fs::path folder = own_catalyst_scripts();
  std::vector<std::string> known;
  for (const char* script : {"coupled", "network", "stress", "template", "vessel"})
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

void find_scripts(PicturesPlan& plan, const std::string& input_file, parallel::Communicator comm) {
  if (!plan.insitu.enabled || plan.insitu.scripts.empty() || !plan.obstacle.empty()) return;
  check_address(plan.insitu.live);
  for (std::string& script : plan.insitu.scripts) {
    std::string found;
    // By the root rank, for ranks may see other files.
    parallel::on_root<InputError>(comm, [&] {
      const fs::path path = fs::canonical(find_script(script, fs::path(input_file).parent_path()));
      if (path.extension() != ".py" && !is_package(path))
        throw InputError(path.string() + " is no Python file (.py), nor a folder with __init__.py", key);
      found = path.string();
    });
    script = comm.broadcast(found);
  }
  try {
    plan.obstacle = insitu::inspect_scripts(settings_for(plan), comm);
  } catch (const InputError& error) {
    throw InputError(error.what(), key);
  }
}

bool Pictures::wants(long step, double time_s) {
  return pipeline && pipeline->wants(step + steps_before, time_s + seconds_before);
}

void Pictures::process(long step, double time_s, const insitu::Channels& channels) {
  staging->open();
  pipeline->process(step + steps_before, time_s + seconds_before, channels);
}

Pictures start_pictures(const PicturesPlan& plan, const output::ResultsFolder& results,
                        parallel::Communicator comm, std::function<void(const std::string&)> before_abort) {
  Pictures pictures;
  if (!plan.insitu.enabled) {
    pictures.description = "off (insitu.enabled = false)";
  } else if (plan.insitu.scripts.empty()) {
    pictures.description = "off (no insitu.scripts)";
  } else if (!plan.obstacle.empty()) {
    pictures.description = "off: " + plan.obstacle;
  }
  if (!pictures.description.empty()) return pictures;
  auto staging = std::make_unique<output::StagingFolder>(results, "images", comm);
  insitu::Settings settings = settings_for(plan);
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

}  // namespace rhexis::runtime
