// SPDX-License-Identifier: BSD-3-Clause
// librhexis_window.so: gives pvpython and pvbatch a window without a display;
// postprocessing/pvpython_headless places it (LD_PRELOAD) before them.
#include <cstdio>
#include <cstdlib>

#include "insitu/window/headless_window.hpp"

namespace {

[[gnu::constructor]] void give_windows() {
  // Programs that ParaView starts (MPI's helper, ffmpeg) are none of our business.
  unsetenv("LD_PRELOAD");
  using namespace rhexis::insitu;
  if (use_headless_windows(Headless::osmesa).empty() && use_headless_windows(Headless::egl).empty()) {
    std::fputs("rhexis: neither OSMesa nor EGL works here; ParaView will look for an X display\n", stderr);
  }
}

}  // namespace
