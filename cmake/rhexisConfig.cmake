# SPDX-License-Identifier: BSD-3-Clause
# find_package(rhexis): the libraries of Rhexis, one for each folder of its headers, as rhexis::peridynamics, rhexis::network, ...
include(${CMAKE_CURRENT_LIST_DIR}/Dependencies.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/rhexisTargets.cmake)
