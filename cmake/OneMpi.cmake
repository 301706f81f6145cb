# SPDX-License-Identifier: BSD-3-Clause
# The MPI library that a shared library needs (ENTRY = NEEDED) or is (ENTRY = SONAME), such as libmpi.so.40 (Open MPI) or
# libmpich.so.12 (MPICH); empty where there is none.
function(rhexis_mpi_library LIBRARY ENTRY RESULT)
  execute_process(COMMAND ${CMAKE_READELF} -d ${LIBRARY} OUTPUT_VARIABLE dynamic ERROR_QUIET)
  string(REGEX MATCH "\\(${ENTRY}\\)[^\n]*\\[(libmpi(ch)?\\.so[^]]*)\\]" found "${dynamic}")
  set(${RESULT} "${CMAKE_MATCH_1}" PARENT_SCOPE)
endfunction()

# Ends unless the shared libraries named were built with the MPI that was found: the linker takes two MPIs without a word,
# and the program crashes or hangs in the first call.
function(rhexis_require_one_mpi)
  set(mpi "")
  foreach(library IN LISTS MPI_C_LIBRARIES)
    rhexis_mpi_library(${library} SONAME soname)
    string(APPEND mpi "${soname}")
  endforeach()
  foreach(library IN LISTS ARGN)
    rhexis_mpi_library(${library} NEEDED needed)
    if(mpi AND needed AND NOT needed STREQUAL mpi)
      message(FATAL_ERROR
        "The MPI found is ${mpi} (by ${MPI_C_COMPILER}), but ${library} was built with ${needed}: two MPIs in one program "
        "do not work. Use one for all. On Debian, hypre and ParaView are built with Open MPI: install libopenmpi-dev and "
        "libhdf5-openmpi-dev, and where another MPI is the default (update-alternatives --config mpi) or cached, configure "
        "in an empty build folder with -DMPI_C_COMPILER=mpicc.openmpi -DMPI_CXX_COMPILER=mpicxx.openmpi")
    endif()
  endforeach()
endfunction()
