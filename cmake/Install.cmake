# SPDX-License-Identifier: BSD-3-Clause
# cmake --install: the program with its plugins, scripts, inputs and docs; and the libraries for find_package(rhexis).
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/rhexis)
set(data ${RHEXIS_DATA_FOLDER})

install(TARGETS rhexis RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
foreach(plugin rhexis_catalyst rhexis_window rhexis_vtp)
  if(TARGET ${plugin})
    set_target_properties(${plugin} PROPERTIES INSTALL_RPATH $ORIGIN/..)
    install(TARGETS ${plugin} LIBRARY DESTINATION ${RHEXIS_PLUGIN_FOLDER})
  endif()
endforeach()
install(DIRECTORY catalyst_scripts inputs DESTINATION ${data} PATTERN __pycache__ EXCLUDE)
# Without the measurements of the program itself, which need a build folder.
install(DIRECTORY postprocessing DESTINATION ${data} USE_SOURCE_PERMISSIONS PATTERN __pycache__ EXCLUDE
        REGEX "/(benchmarks|compare_peers|lammps_peri|network_speed_and_error|onset|speed_against_error|verify)\\.py$" EXCLUDE)
install(FILES README.md CHANGELOG.md CITATION.cff LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR})

install(DIRECTORY src/ ${PROJECT_BINARY_DIR}/include/core DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/rhexis
        FILES_MATCHING PATTERN "*.hpp")
install(EXPORT rhexis NAMESPACE rhexis:: FILE rhexisTargets.cmake DESTINATION ${package})
include(CMakePackageConfigHelpers)
write_basic_package_version_file(rhexisConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/rhexisConfig.cmake cmake/Dependencies.cmake cmake/Hdf5.cmake cmake/OneMpi.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/rhexisConfigVersion.cmake DESTINATION ${package})
