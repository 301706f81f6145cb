// SPDX-License-Identifier: BSD-3-Clause
#include "core/plugin.hpp"
#include "insitu/pipeline.hpp"
#include "insitu/window/libraries.hpp"
#include "parallel/together.hpp"

namespace rhexis::insitu {
namespace {

constexpr const char* library = "librhexis_catalyst.so";

/// Opens the plugin; `reason` says why where it cannot be.
void* open(const Settings& settings, std::string& reason) {
  if (!plugin_available() && *RHEXIS_NOT_BUILT != '\0') {
    reason = std::string("not available: ") + RHEXIS_NOT_BUILT;
    return nullptr;
  }
  // OSMesa first: whoever comes first in the global scope provides the gl... functions that VTK calls
  // directly.
  const bool may_be_osmesa =
      settings.renderer == Renderer::automatic || settings.renderer == Renderer::osmesa;
  if (may_be_osmesa && plugin_available()) open_osmesa();
  // Global, because Python's extension modules look for Python and VTK there; lazy, because binding every
  // function of ParaView's 400 libraries takes as long again as loading them.
  return open_plugin(library, RTLD_LAZY | RTLD_GLOBAL, reason);
}

}  // namespace

bool plugin_available() {
  return has_plugin(library);
}

std::string inspect_scripts(const Settings& settings, parallel::Communicator communicator) {
  std::string reason;
  void* plugin = open(settings, reason);
  reason = communicator.first_non_empty(reason);
  if (!reason.empty()) return reason;
  auto* inspect = reinterpret_cast<InspectScripts*>(dlsym(plugin, inspect_scripts_symbol));
  parallel::together<InputError>(communicator, [&] { inspect(settings, reason); });
  return communicator.first_non_empty(reason);
}

std::unique_ptr<Pipeline> load_pipeline(const Settings& settings, parallel::Communicator communicator) {
  std::string reason;
  void* plugin = open(settings, reason);
  reason = communicator.first_non_empty(reason);
  if (!reason.empty()) throw NotAvailable(reason);
  auto* create = reinterpret_cast<CreatePipeline*>(dlsym(plugin, create_pipeline_symbol));
  return std::unique_ptr<Pipeline>(create(settings, communicator));
}

}  // namespace rhexis::insitu
