# SPDX-License-Identifier: BSD-3-Clause
# A portable build runs on every x86-64 processor since 2009 (level x86-64-v2: SSE4.2) and is as fast as one for the machine at
# hand: libraries with vector code are built for newer levels too (v3: AVX2; v4: AVX-512), and the dynamic loader takes the best
# that the processor has, from glibc-hwcaps/<level> beside the library. Each level is a whole library, so that no function that
# two levels share can be taken from the wrong one.
include(CheckCXXCompilerFlag)
set(RHEXIS_LEVELS "")
if(NOT RHEXIS_NATIVE AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  check_cxx_compiler_flag(-march=x86-64-v4 RHEXIS_KNOWS_LEVELS)
  if(RHEXIS_KNOWS_LEVELS)
    # The property is the target's that is compiled, not the one that passes this option on.
    set(RHEXIS_BASELINE -march=$<IF:$<BOOL:$<TARGET_PROPERTY:RHEXIS_LEVEL>>,$<TARGET_PROPERTY:RHEXIS_LEVEL>,x86-64-v2>)
    if(BUILD_SHARED_LIBS)
      set(RHEXIS_LEVELS x86-64-v3 x86-64-v4)
    endif()
  endif()
endif()

# rhexis_for_processors(TARGET): the same library for each level, to be called last in the folder that adds it.
function(rhexis_for_processors TARGET)
  get_target_property(sources ${TARGET} SOURCES)
  get_target_property(libraries ${TARGET} LINK_LIBRARIES)
  get_target_property(definitions ${TARGET} COMPILE_DEFINITIONS)
  foreach(level IN LISTS RHEXIS_LEVELS)
    set(variant ${TARGET}-${level})
    add_library(${variant} SHARED ${sources})
    target_link_libraries(${variant} PRIVATE ${libraries})
    if(definitions)
      target_compile_definitions(${variant} PRIVATE ${definitions})
    endif()
    if(level STREQUAL x86-64-v4)
      target_compile_options(${variant} PRIVATE -mprefer-vector-width=512)  # g++ takes halves unless told of one processor
    endif()
    set(folder ${CMAKE_INSTALL_LIBDIR}/glibc-hwcaps/${level})
    set_target_properties(${variant} PROPERTIES RHEXIS_LEVEL ${level} OUTPUT_NAME ${TARGET} INSTALL_RPATH $ORIGIN/../..
      LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/${folder} VERSION ${PROJECT_VERSION} SOVERSION ${RHEXIS_SOVERSION})
    install(TARGETS ${variant} LIBRARY DESTINATION ${folder} NAMELINK_SKIP)
    add_dependencies(${TARGET} ${variant})
  endforeach()
endfunction()
