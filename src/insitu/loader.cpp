#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>

#include "insitu/pipeline.hpp"
#include "insitu/window/libraries.hpp"

namespace rhexis::insitu {
namespace {

std::filesystem::path plugin_path() {
  const char* folder = std::getenv("RHEXIS_PLUGIN_DIR");
  if (folder != nullptr) return std::filesystem::path(folder) / "librhexis_catalyst.so";
  const auto program = std::filesystem::read_symlink("/proc/self/exe");
  return program.parent_path().parent_path() / "lib" / "librhexis_catalyst.so";
}

/// Opens the plugin; `reason` says why where it cannot be.
void* open_plugin(const Settings& settings, std::string& reason) {
  const auto path = plugin_path();
  if (!std::filesystem::exists(path)) {
    reason =
        "not available: no " + path.string() + " (built only where ParaView's development files are found)";
    return nullptr;
  }
  // OSMesa first: whoever comes first in the global scope provides the gl... functions that VTK calls
  // directly.
  if (settings.renderer == Renderer::automatic || settings.renderer == Renderer::osmesa) open_osmesa();
  // Global, because Python's extension modules look for Python and VTK there; lazy, because binding every
  // function of ParaView's 400 libraries takes as long again as loading them.
  void* plugin = dlopen(path.c_str(), RTLD_LAZY | RTLD_GLOBAL);
  if (plugin == nullptr) reason = std::string("not available: ") + dlerror();
  return plugin;
}

}  // namespace

bool plugin_available() {
  std::error_code ignored;
  return std::filesystem::exists(plugin_path(), ignored);
}

std::unique_ptr<Pipeline> load_pipeline(const Settings& settings, parallel::Communicator communicator) {
  std::string reason;
  void* plugin = open_plugin(settings, reason);
  reason = communicator.first_non_empty(reason);
  if (!reason.empty()) throw NotAvailable(reason);
  auto* create = reinterpret_cast<CreatePipeline*>(dlsym(plugin, create_pipeline_symbol));
  return std::unique_ptr<Pipeline>(create(settings, communicator));
}

}  // namespace rhexis::insitu
