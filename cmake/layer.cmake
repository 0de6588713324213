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
            # nobody reads errno or the exception flags after arithmetic; loops may become vectors,
            # with the same results
            -fno-math-errno -fno-trapping-math
            # GCC 12 leaves out the rounding of double to float and back in two of three neighbouring lanes
            $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>
            $<$<BOOL:${GLIDAR_WARNINGS_AS_ERRORS}>:-Werror>
            # GCC 12 takes texts that are joined for overlapping ones (PR 105329), depending on what it inlines
            $<$<CXX_COMPILER_ID:GNU>:-Wno-error=restrict>
            # GCC 14 takes the content of empty std::optionals for uninitialised
            $<$<CXX_COMPILER_ID:GNU>:-Wno-error=maybe-uninitialized>
            # in unity builds GCC takes the types of sources for those of headers
            $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${GLIDAR_UNITY_BUILD}>>:-Wno-subobject-linkage>
            # GCC 14 takes references that outlive an argument for references into it; GCC 12 has no such warning
            $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,13>>:-Wno-dangling-reference>)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64|ARM64")
  target_compile_options(glidar_settings INTERFACE "SHELL:-include ${CMAKE_CURRENT_LIST_DIR}/neon_without_fma.h")
endif()
glidar_harden(glidar_settings INTERFACE)

# glidar_gather(LIST REGEX...): moves the sources that include these headers to the front of the list, one regular
# expression after the other. Unity builds compile neighbours together, so few of them parse these expensive headers.
function(glidar_gather list)
  set(gathered)
  set(others ${${list}})
  foreach(regex IN LISTS ARGN)
    foreach(source IN LISTS others)
      file(STRINGS ${source} found REGEX "^#include [<\"]${regex}" LIMIT_COUNT 1)
      if(found)
        list(APPEND gathered ${source})
      endif()
    endforeach()
    if(gathered)
      list(REMOVE_ITEM others ${gathered})
    endif()
  endforeach()
  set(${list} ${gathered} ${others} PARENT_SCOPE)
endfunction()

# glidar_layer(NAME SOURCES files... PUBLIC layers... PRIVATE libraries...): one library per layer,
# by default from all sources of the folder of its name.
function(glidar_layer name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  if(NOT ARG_SOURCES)
    file(GLOB_RECURSE ARG_SOURCES CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
  endif()
  glidar_gather(ARG_SOURCES nlohmann/ glidar/io/config/\(json|field_json|camera_info\) yaml-cpp/)
  add_library(glidar_${name} ${ARG_SOURCES})
  add_library(glidar::${name} ALIAS glidar_${name})
  set_target_properties(
    glidar_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON
                              VERSION ${PROJECT_VERSION}
                              SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_include_directories(
    glidar_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                          $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(glidar_${name} PUBLIC ${ARG_PUBLIC}
                        PRIVATE $<BUILD_INTERFACE:glidar_settings> ${ARG_PRIVATE})
  target_compile_features(glidar_${name} PUBLIC cxx_std_20)
  set_property(GLOBAL APPEND PROPERTY GLIDAR_LAYER_TARGETS glidar_${name})
endfunction()
