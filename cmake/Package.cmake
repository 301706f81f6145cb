# SPDX-License-Identifier: BSD-3-Clause
# cpack -G DEB in the build folder: a package for the Debian that it is built on. Build it by the preset `portable`, so that it
# runs on any processor.
set(CPACK_PACKAGE_NAME rhexis)
set(CPACK_PACKAGE_VENDOR "The Rhexis authors")
set(CPACK_PACKAGE_CONTACT "The Rhexis authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "blood flow in vascular networks and peridynamic rupture of vessel walls")
set(CPACK_PACKAGE_DESCRIPTION "Simulates steady flow of blood in networks of up to 34 billion vessels and the rupture of a
vessel's wall, with MPI and OpenMP; it draws while it runs, through ParaView Catalyst and without a display.")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
# The libraries' packages are found by dpkg-shlibdeps; what is only opened when it is used is named here.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS openmpi-bin)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-paraview, libosmesa6, libegl1, ffmpeg, python3-numpy, python3-matplotlib, python3-h5py")
include(CPack)
