// SPDX-License-Identifier: BSD-3-Clause
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>

#include <array>

#include "insitu/window/gl_context.hpp"

namespace rhexis::insitu {
namespace {

struct Egl {
  decltype(&eglGetPlatformDisplay) platform_display = nullptr;
  decltype(&eglInitialize) initialize = nullptr;
  decltype(&eglBindAPI) bind_api = nullptr;
  decltype(&eglChooseConfig) choose_config = nullptr;
  decltype(&eglCreatePbufferSurface) create_surface = nullptr;
  decltype(&eglDestroySurface) destroy_surface = nullptr;
  decltype(&eglCreateContext) create_context = nullptr;
  decltype(&eglDestroyContext) destroy_context = nullptr;
  decltype(&eglMakeCurrent) make_current = nullptr;
  decltype(&eglGetCurrentContext) current = nullptr;
  EGLDisplay display = EGL_NO_DISPLAY;

  Egl() {
    void* library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_GLOBAL);
    if (library == nullptr) return;
    const auto load = [library](auto& pointer, const char* name) {
      pointer = reinterpret_cast<std::remove_reference_t<decltype(pointer)>>(dlsym(library, name));
    };
    load(platform_display, "eglGetPlatformDisplay");
    load(initialize, "eglInitialize");
    load(bind_api, "eglBindAPI");
    load(choose_config, "eglChooseConfig");
    load(create_surface, "eglCreatePbufferSurface");
    load(destroy_surface, "eglDestroySurface");
    load(create_context, "eglCreateContext");
    load(destroy_context, "eglDestroyContext");
    load(make_current, "eglMakeCurrent");
    load(current, "eglGetCurrentContext");
    display = platform_display(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
    // Kept for the life of the process: windows share it.
    if (display != EGL_NO_DISPLAY && initialize(display, nullptr, nullptr) != EGL_TRUE)
      display = EGL_NO_DISPLAY;
  }
};

const Egl& egl() {
  static const Egl library;
  return library;
}

class EglContext : public GlContext {
 public:
  EglContext(EGLContext context, EGLSurface surface) : context_(context), surface_(surface) {}
  ~EglContext() override {
    if (is_current()) release_current();
    egl().destroy_surface(egl().display, surface_);
    egl().destroy_context(egl().display, context_);
  }

  void make_current() override { egl().make_current(egl().display, surface_, surface_, context_); }
  void release_current() override {
    egl().make_current(egl().display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  bool is_current() const override { return egl().current() == context_; }
  void* handle() const override { return context_; }

 private:
  EGLContext context_;
  EGLSurface surface_;
};

}  // namespace

std::unique_ptr<GlContext> create_egl_context() {
  if (egl().display == EGL_NO_DISPLAY || egl().bind_api(EGL_OPENGL_API) != EGL_TRUE) return nullptr;
  const std::array<EGLint, 9> wanted{EGL_SURFACE_TYPE,
                                     EGL_PBUFFER_BIT,
                                     EGL_RENDERABLE_TYPE,
                                     EGL_OPENGL_BIT,
                                     EGL_RED_SIZE,
                                     8,
                                     EGL_DEPTH_SIZE,
                                     24,
                                     EGL_NONE};
  EGLConfig config = nullptr;
  EGLint found = 0;
  if (egl().choose_config(egl().display, wanted.data(), &config, 1, &found) != EGL_TRUE || found == 0)
    return nullptr;

  // The surface is never drawn to, but VTK asks for its colour sizes.
  const std::array<EGLint, 5> size{EGL_WIDTH, 64, EGL_HEIGHT, 64, EGL_NONE};
  const std::array<EGLint, 7> version{EGL_CONTEXT_MAJOR_VERSION,
                                      3,
                                      EGL_CONTEXT_MINOR_VERSION,
                                      2,
                                      EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                      EGL_NONE};
  EGLSurface surface = egl().create_surface(egl().display, config, size.data());
  EGLContext context = egl().create_context(egl().display, config, EGL_NO_CONTEXT, version.data());
  if (surface == EGL_NO_SURFACE || context == EGL_NO_CONTEXT) return nullptr;
  return std::make_unique<EglContext>(context, surface);
}

std::unique_ptr<GlContext> create_context(Headless kind) {
  switch (kind) {
    case Headless::osmesa:
      return create_osmesa_context();
    case Headless::egl:
      return create_egl_context();
    case Headless::none:
      break;
  }
  return nullptr;
}

}  // namespace rhexis::insitu
