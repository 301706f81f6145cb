// SPDX-License-Identifier: BSD-3-Clause
/// The one graphics library that must be loaded before VTK.
#pragma once

#include <dlfcn.h>

namespace rhexis::insitu {

/// Puts OSMesa in the global scope; null where it is not installed.
inline void* open_osmesa() {
  return dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_GLOBAL);
}

}  // namespace rhexis::insitu
