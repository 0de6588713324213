# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause

# Tests of the interfaces of sensors for drivers; two of them are served with Boost only.
if(NOT GLIDAR_HAS_BEAST)
  return()
endif()
glidar_tests(link/control glidar::link nlohmann_json::nlohmann_json)
target_sources(glidar_link_control_tests PRIVATE fuzz/control_decoders.cpp)
