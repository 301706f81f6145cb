// SPDX-License-Identifier: BSD-3-Clause
#include "insitu/window/headless_window.hpp"

#include <dlfcn.h>
#include <vtkObjectFactory.h>
#include <vtkVersion.h>

#include <array>

namespace rhexis::insitu {
namespace {

Headless current_kind = Headless::none;

vtkObject* new_headless_window() {
  return HeadlessWindow::New();
}

class HeadlessFactory : public vtkObjectFactory {
 public:
  static HeadlessFactory* New() {
    auto* factory = new HeadlessFactory;
    factory->InitializeObjectBase();
    return factory;
  }
  const char* GetVTKSourceVersion() override { return VTK_SOURCE_VERSION; }
  const char* GetDescription() override { return "Rhexis: windows without a display"; }

 private:
  HeadlessFactory() {
    RegisterOverride("vtkRenderWindow", "HeadlessWindow", "no display", 1, &new_headless_window);
  }

  vtkTypeMacro(HeadlessFactory, vtkObjectFactory)
};

std::string renderer_name(GlContext& context) {
  using GetString = const unsigned char* (*)(unsigned);
  constexpr unsigned gl_renderer = 0x1F01;
  const auto get_string = reinterpret_cast<GetString>(dlsym(RTLD_DEFAULT, "glGetString"));
  context.make_current();
  const unsigned char* name = get_string == nullptr ? nullptr : get_string(gl_renderer);
  std::string result = name == nullptr ? "" : reinterpret_cast<const char*>(name);
  context.release_current();
  return result;
}

}  // namespace

Headless headless_kind() {
  return current_kind;
}

std::string use_headless_windows(Headless kind) {
  auto context = create_context(kind);
  std::string name = context == nullptr ? "" : renderer_name(*context);
  if (name.empty()) return name;
  current_kind = kind;
  // Switch off the X11 window before registering ours, because the first enabled override wins.
  vtkObjectFactory::SetAllEnableFlags(0, "vtkRenderWindow");
  vtkObjectFactory::SetAllEnableFlags(0, "vtkRenderWindowInteractor");
  auto* factory = HeadlessFactory::New();
  vtkObjectFactory::RegisterFactory(factory);
  factory->Delete();
  return name;
}

HeadlessWindow* HeadlessWindow::New() {
  auto* window = new HeadlessWindow;
  window->InitializeObjectBase();
  return window;
}

HeadlessWindow::HeadlessWindow() {
  SetWindowName("Rhexis");
  ShowWindow = false;
  UseOffScreenBuffers = true;
  MultiSamples = 0;
  FrameBlitMode = NoBlit;
}

HeadlessWindow::~HeadlessWindow() {
  HeadlessWindow::Finalize();
}

void HeadlessWindow::Initialize() {
  if (context_ == nullptr) CreateAWindow();
}

void HeadlessWindow::CreateAWindow() {
  context_ = create_context(current_kind);
  if (context_ == nullptr) {
    vtkErrorMacro("no OpenGL 3.2 context");
    return;
  }
  Mapped = 1;
  OwnContext = 1;
  if (Size[0] <= 0 || Size[1] <= 0) {
    Size[0] = 300;
    Size[1] = 300;
  }
  MakeCurrent();
  OpenGLInit();
}

void HeadlessWindow::Finalize() {
  if (context_ != nullptr) DestroyWindow();
}

void HeadlessWindow::DestroyWindow() {
  MakeCurrent();
  ReleaseGraphicsResources(this);
  ReleaseCurrent();
  context_.reset();
}

void HeadlessWindow::Start() {
  Initialize();
  Superclass::Start();
}

void HeadlessWindow::MakeCurrent() {
  if (context_ != nullptr) context_->make_current();
}

void HeadlessWindow::ReleaseCurrent() {
  if (context_ != nullptr && context_->is_current()) context_->release_current();
}

bool HeadlessWindow::IsCurrent() {
  return context_ != nullptr && context_->is_current();
}

void* HeadlessWindow::GetGenericContext() {
  return context_ == nullptr ? nullptr : context_->handle();
}

int* HeadlessWindow::GetScreenSize() {
  // No screen limits the size of a picture; ParaView only wants a plausible answer.
  ScreenSize[0] = 8192;
  ScreenSize[1] = 8192;
  return ScreenSize;
}

}  // namespace rhexis::insitu
