# SPDX-License-Identifier: BSD-3-Clause
# The target `tidy`: static analysis of all sources by the checks of .clang-tidy (Debian: clang-tidy).
find_program(RHEXIS_RUN_CLANG_TIDY run-clang-tidy)
mark_as_advanced(RHEXIS_RUN_CLANG_TIDY)
if(RHEXIS_RUN_CLANG_TIDY)
  add_custom_target(tidy COMMAND ${RHEXIS_RUN_CLANG_TIDY} -quiet -p ${PROJECT_BINARY_DIR} "^${PROJECT_SOURCE_DIR}/(src|python)/"
                    VERBATIM USES_TERMINAL)
endif()
