# SPDX-License-Identifier: BSD-3-Clause
# ParaView's VTK, looked for once: for the pictures (src/insitu) and for VTP files (src/network/files/vtp).
if(NOT RHEXIS_INSITU)
  return()
endif()

# Debian 13's ParaView 5.13 names Python modules under other file names than it installs, and its own files end CMake over
# that; they leave out a target for which this variable of theirs names a folder. The impossible version only asks where they are.
set(paraview_dir "${ParaView_DIR}")
find_package(ParaView 999 EXACT QUIET CONFIG)
foreach(config IN LISTS ParaView_CONSIDERED_CONFIGS)
  cmake_path(GET config PARENT_PATH folder)
  file(GLOB exported ${folder}/ParaViewPython*-targets.cmake ${folder}/vtk/VTKPython-targets.cmake)
  foreach(file IN LISTS exported)
    file(STRINGS ${file} modules REGEX "^add_library\\([^ ]+ MODULE IMPORTED\\)")
    foreach(module IN LISTS modules)
      string(REGEX REPLACE "^add_library\\(([^ ]+) .*" "\\1" module "${module}")
      set(_cmake_import_check_xcframework_for_${module} ${folder})
    endforeach()
  endforeach()
endforeach()
set(ParaView_DIR "${paraview_dir}" CACHE PATH "The folder of paraview-config.cmake" FORCE)

# The window of src/insitu replaces parts of VTK that changed in VTK 9.4, which needs none of this; ParaView 5.13 has 9.3.
find_package(ParaView 5.11...<5.14 QUIET COMPONENTS Catalyst PythonCatalyst)
if(NOT ParaView_FOUND)
  return()
endif()
get_target_property(vtk_parallel_mpi VTK::ParallelMPI LOCATION)
rhexis_require_one_mpi(${vtk_parallel_mpi})

# Debian's ParaView names private dependencies that it does not find; nothing of ours uses them.
foreach(target Freetype::Freetype X11::X11 GLEW::GLEW OpenGL::GLX OpenGL::OpenGL LibXml2::LibXml2 hdf5::hdf5 hdf5::hdf5_hl
               Boost::boost NetCDF::NetCDF)
  if(NOT TARGET ${target})
    add_library(${target} INTERFACE IMPORTED)
  endif()
endforeach()
