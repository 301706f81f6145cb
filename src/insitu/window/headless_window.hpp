// SPDX-License-Identifier: BSD-3-Clause
/// VTK's render window without a display. Debian's VTK has an X11 window only; this one takes its place.
#pragma once

#include <vtkOpenGLRenderWindow.h>

#include <memory>
#include <string>

#include "insitu/window/gl_context.hpp"

namespace rhexis::insitu {

/// VTK draws into a frame buffer object of its own, so that the window is no more than an OpenGL context.
class HeadlessWindow : public vtkOpenGLRenderWindow {
 public:
  static HeadlessWindow* New();

  void Initialize() override;
  void Finalize() override;
  void Start() override;
  void MakeCurrent() override;
  void ReleaseCurrent() override;
  bool IsCurrent() override;
  void* GetGenericContext() override;
  int* GetScreenSize() override;

 protected:
  HeadlessWindow();
  ~HeadlessWindow() override;
  void CreateAWindow() override;
  void DestroyWindow() override;

 private:
  HeadlessWindow(const HeadlessWindow&) = delete;
  void operator=(const HeadlessWindow&) = delete;

  std::unique_ptr<GlContext> context_;

  vtkTypeMacro(HeadlessWindow, vtkOpenGLRenderWindow)
};

/// From now on VTK makes windows of this kind. Returns what OpenGL says of its renderer, e.g. "llvmpipe
/// (...)"; empty (and nothing changed) where such a context cannot be made.
std::string use_headless_windows(Headless kind);

/// What windows are made of at present.
Headless headless_kind();

}  // namespace rhexis::insitu
