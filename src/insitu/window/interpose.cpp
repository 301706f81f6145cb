// SPDX-License-Identifier: BSD-3-Clause
// Functions of GLEW and GLX that VTK finds here before it finds the real ones: Debian's GLEW knows no
// window system but GLX, and would give up without a display.
#include <dlfcn.h>

#include <cstring>

#include "insitu/window/headless_window.hpp"

using rhexis::insitu::GlContext;
using rhexis::insitu::Headless;
using rhexis::insitu::headless_kind;
using rhexis::insitu::osmesa_function;

namespace {

GlContext::Function function_address(const char* entry_point, const char* name) {
  if (headless_kind() == Headless::osmesa) {
    return std::strncmp(name, "glX", 3) == 0 ? nullptr : osmesa_function(name);
  }
  using Lookup = GlContext::Function (*)(const unsigned char*);
  const auto next = reinterpret_cast<Lookup>(dlsym(RTLD_NEXT, entry_point));
  return next == nullptr ? nullptr : next(reinterpret_cast<const unsigned char*>(name));
}

}  // namespace

extern "C" {

#pragma GCC visibility push(default)

/// By the time that GLEW finds no GLX display (results 3 and 4) it has loaded every OpenGL function.
unsigned glewInit() {
  using Init = unsigned (*)();
  const auto next = reinterpret_cast<Init>(dlsym(RTLD_NEXT, "glewInit"));
  const unsigned result = next == nullptr ? 1 : next();
  const bool only_glx_missing = result == 3 || result == 4;
  return only_glx_missing && headless_kind() != Headless::none ? 0 : result;
}

GlContext::Function glXGetProcAddressARB(const unsigned char* name) {
  return function_address("glXGetProcAddressARB", reinterpret_cast<const char*>(name));
}

GlContext::Function glXGetProcAddress(const unsigned char* name) {
  return function_address("glXGetProcAddress", reinterpret_cast<const char*>(name));
}

#pragma GCC visibility pop
}
