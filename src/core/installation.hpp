// SPDX-License-Identifier: BSD-3-Clause
/// The files that belong to the program: found beside it, so that an installation may be moved. The build
/// folder has the same layout as an installation.
#pragma once

#include <dlfcn.h>

#include <filesystem>

#include "core/install_layout.hpp"

namespace rhexis {

/// The nearest folder above `file` that has `data_folder`; empty where there is none.
inline std::filesystem::path prefix_above(const std::filesystem::path& file) {
  std::error_code ignored;
  const std::filesystem::path real = std::filesystem::canonical(file, ignored);
  for (auto folder = real.parent_path(); folder != folder.root_path(); folder = folder.parent_path())
    if (std::filesystem::exists(folder / data_folder, ignored)) return folder;
  return {};
}

/// The folder that was given as CMAKE_INSTALL_PREFIX, wherever it is now: the one above the program or, where
/// that is another's program (Python), above the library that holds this code; otherwise as configured.
inline std::filesystem::path installation_prefix() {
  static const char own_place = 0;
  Dl_info holder{};
  const bool is_library = dladdr(&own_place, &holder) != 0 && holder.dli_fname != nullptr;
  // A program's own name may be relative to a folder that has changed since.
  if (is_library && *holder.dli_fname == '/') {
    if (auto prefix = prefix_above(holder.dli_fname); !prefix.empty()) return prefix;
  }
  auto prefix = prefix_above("/proc/self/exe");
  return prefix.empty() ? std::filesystem::path(configured_prefix) : prefix;
}

/// The folder of Rhexis's own Catalyst scripts.
inline std::filesystem::path own_catalyst_scripts() {
  return installation_prefix() / data_folder / "catalyst_scripts";
}

}  // namespace rhexis
