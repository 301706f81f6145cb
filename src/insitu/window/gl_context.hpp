// SPDX-License-Identifier: BSD-3-Clause
/// An OpenGL context without a display. Both kinds are opened at run time (dlopen), so neither library is
/// needed to start the program.
#pragma once

#include <memory>

namespace rhexis::insitu {

class GlContext {
 public:
  using Function = void (*)();

  GlContext() = default;
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;
  virtual ~GlContext() = default;

  virtual void make_current() = 0;
  virtual void release_current() = 0;
  virtual bool is_current() const = 0;
  virtual void* handle() const = 0;  ///< distinguishes contexts, nothing else
};

/// What can make contexts.
enum class Headless { none, osmesa, egl };

/// OpenGL 3.2 core; null where the library is missing or refuses.
std::unique_ptr<GlContext> create_osmesa_context();
std::unique_ptr<GlContext> create_egl_context();
std::unique_ptr<GlContext> create_context(Headless kind);

/// Address of an OpenGL function by OSMesa, null without OSMesa.
GlContext::Function osmesa_function(const char* name);

}  // namespace rhexis::insitu
