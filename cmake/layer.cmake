# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause

# Settings every target of the project shares.
add_library(glidar_settings INTERFACE)
target_compile_features(glidar_settings INTERFACE cxx_std_20)
target_compile_options(
  glidar_settings
  INTERFACE -Wall -Wextra -Wshadow -Wconversion
            # no fused multiply-add behind our back: the same bytes from every build type
            -ffp-contract=off
            $<$<BOOL:${GLIDAR_WARNINGS_AS_ERRORS}>:-Werror>)

# glidar_layer(NAME PUBLIC layers... PRIVATE libraries...): one library per folder of glidar/, from
# all its sources.
function(glidar_layer name)
  cmake_parse_arguments(ARG "" "" "PUBLIC;PRIVATE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
  add_library(glidar_${name} ${sources})
  add_library(glidar::${name} ALIAS glidar_${name})
  set_target_properties(glidar_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(
    glidar_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                          $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(glidar_${name} PUBLIC ${ARG_PUBLIC}
                        PRIVATE $<BUILD_INTERFACE:glidar_settings> ${ARG_PRIVATE})
  target_compile_features(glidar_${name} PUBLIC cxx_std_20)
endfunction()
