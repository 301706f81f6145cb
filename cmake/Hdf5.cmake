# SPDX-License-Identifier: BSD-3-Clause
# Parallel HDF5, as hdf5::hdf5.
block(PROPAGATE HDF5_C_LIBRARIES HDF5_VERSION)
  # FindHDF5 asks HDF5's compiler wrapper, which on Debian 12 is a script that fails in a path with a space; then it
  # searches where pkg-config says.
  pkg_search_module(HDF5_HINT QUIET hdf5-openmpi hdf5-mpich hdf5)
  list(APPEND CMAKE_INCLUDE_PATH ${HDF5_HINT_INCLUDE_DIRS})
  list(APPEND CMAKE_LIBRARY_PATH ${HDF5_HINT_LIBRARY_DIRS})
  set(HDF5_PREFER_PARALLEL ON)
  find_package(HDF5 REQUIRED COMPONENTS C)
  if(NOT HDF5_IS_PARALLEL)
    message(FATAL_ERROR "Rhexis needs a parallel HDF5 (Debian: libhdf5-openmpi-dev)")
  endif()
endblock()
