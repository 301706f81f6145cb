// SPDX-License-Identifier: BSD-3-Clause
#include <GL/osmesa.h>

#include <array>

#include "insitu/window/gl_context.hpp"
#include "insitu/window/libraries.hpp"

namespace rhexis::insitu {
namespace {

constexpr int dummy_size = 64;  // VTK draws to a frame buffer object of its own

struct OsMesa {
  decltype(&OSMesaCreateContextAttribs) create = nullptr;
  decltype(&OSMesaDestroyContext) destroy = nullptr;
  decltype(&OSMesaMakeCurrent) make_current = nullptr;
  decltype(&OSMesaGetCurrentContext) current = nullptr;
  decltype(&OSMesaGetProcAddress) function = nullptr;

  OsMesa() {
    void* library = open_osmesa();
    if (library == nullptr) return;
    const auto load = [library](auto& pointer, const char* name) {
      pointer = reinterpret_cast<std::remove_reference_t<decltype(pointer)>>(dlsym(library, name));
    };
    load(create, "OSMesaCreateContextAttribs");
    load(destroy, "OSMesaDestroyContext");
    load(make_current, "OSMesaMakeCurrent");
    load(current, "OSMesaGetCurrentContext");
    load(function, "OSMesaGetProcAddress");
  }
};

const OsMesa& osmesa() {
  static const OsMesa library;
  return library;
}

class OsMesaContext : public GlContext {
 public:
  explicit OsMesaContext(OSMesaContext context) : context_(context) {}
  ~OsMesaContext() override { osmesa().destroy(context_); }

  void make_current() override {
    osmesa().make_current(context_, buffer_.data(), GL_UNSIGNED_BYTE, dummy_size, dummy_size);
  }
  void release_current() override { osmesa().make_current(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }
  bool is_current() const override { return osmesa().current() == context_; }
  void* handle() const override { return context_; }

 private:
  OSMesaContext context_;
  std::array<unsigned char, std::size_t{4} * dummy_size * dummy_size> buffer_{};
};

}  // namespace

std::unique_ptr<GlContext> create_osmesa_context() {
  if (osmesa().create == nullptr) return nullptr;
  const std::array<int, 13> attributes{OSMESA_FORMAT,
                                       OSMESA_RGBA,
                                       OSMESA_DEPTH_BITS,
                                       24,
                                       OSMESA_STENCIL_BITS,
                                       8,
                                       OSMESA_PROFILE,
                                       OSMESA_CORE_PROFILE,
                                       OSMESA_CONTEXT_MAJOR_VERSION,
                                       3,
                                       OSMESA_CONTEXT_MINOR_VERSION,
                                       2,
                                       0};
  OSMesaContext context = osmesa().create(attributes.data(), nullptr);
  if (context == nullptr) return nullptr;
  return std::make_unique<OsMesaContext>(context);
}

GlContext::Function osmesa_function(const char* name) {
  return osmesa().function == nullptr ? nullptr : osmesa().function(name);
}

}  // namespace rhexis::insitu
