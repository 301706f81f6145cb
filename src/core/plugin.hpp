// SPDX-License-Identifier: BSD-3-Clause
/// Plugins: libraries that need ParaView, opened only when their work is asked for. Each is looked for in the
/// folder RHEXIS_PLUGIN_DIR (environment variable) or else in the installation's (core/installation.hpp).
#pragma once

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "core/installation.hpp"

namespace rhexis {

/// Where the plugin `library` (a file name) has its place, there or not.
inline std::filesystem::path plugin_path(const std::string& library) {
  const char* folder = std::getenv("RHEXIS_PLUGIN_DIR");
  if (folder != nullptr) return std::filesystem::path(folder) / library;
  return installation_prefix() / plugin_folder / library;
}

/// Whether the plugin's file is in its place; costs nothing.
inline bool has_plugin(const std::string& library) {
  std::error_code ignored;
  return std::filesystem::exists(plugin_path(library), ignored);
}

/// Opens the plugin with dlopen's `mode`; null where it cannot be, and `reason` says why.
inline void* open_plugin(const std::string& library, int mode, std::string& reason) {
  const auto path = plugin_path(library);
  if (!has_plugin(library)) {
    reason = "not available: there is no " + path.string() +
             " (the environment variable RHEXIS_PLUGIN_DIR may name its folder)";
    return nullptr;
  }
  void* plugin = dlopen(path.c_str(), mode);
  if (plugin == nullptr) reason = std::string("not available: ") + dlerror();
  return plugin;
}

}  // namespace rhexis
