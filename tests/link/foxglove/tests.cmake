# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause

# Tests of the live view: in C++; with clients from npm; with the page in a browser without a display.
if(NOT GLIDAR_HAS_BEAST)
  return()
endif()
glidar_tests(link/foxglove glidar::link nlohmann_json::nlohmann_json)
target_sources(glidar_link_foxglove_tests PRIVATE fuzz/foxglove_decoders.cpp)
file(GLOB feed_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/link/foxglove/feed/*.cpp)
add_executable(glidar_foxglove_feed ${feed_sources})
target_include_directories(glidar_foxglove_feed PRIVATE ${CMAKE_CURRENT_BINARY_DIR}
                                                        ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(glidar_foxglove_feed PRIVATE glidar_settings glidar::link glidar::explain
                                                   glidar::io)
add_dependencies(glidar_foxglove_feed glidar_import)
set(GLIDAR_NODE_MODULES ${PROJECT_SOURCE_DIR}/build/npm/node_modules
    CACHE PATH "Packages of tests/link/foxglove/package.json")
find_program(NODE_PROGRAM node)
if(NODE_PROGRAM)
  file(GLOB node_tests CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} link/foxglove/*_test.mjs apps/*_test.mjs)
  foreach(script IN LISTS node_tests)
    add_test(NAME "node: ${script}" COMMAND ${NODE_PROGRAM} ${CMAKE_CURRENT_SOURCE_DIR}/${script})
    set_tests_properties("node: ${script}" PROPERTIES SKIP_RETURN_CODE 77 ENVIRONMENT
      "GLIDAR_FOXGLOVE_FEED=$<TARGET_FILE:glidar_foxglove_feed>;GLIDAR_PROGRAM=$<TARGET_FILE:glidar_app>;GLIDAR_NODE_MODULES=${GLIDAR_NODE_MODULES}")
  endforeach()
else()
  glidar_skipped_test("node: live view" "there is no Node.js; ./dev test --all installs it")
endif()
