# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
# The overlay port `vcpkg install glidar --overlay-ports=packaging/vcpkg`: builds the sources that it lies in. vcpkg has no
# libseccomp, so that of the system is used.
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
vcpkg_cmake_configure(
  SOURCE_PATH ${SOURCE_PATH}
  OPTIONS -DGLIDAR_BUILD_VIEWER=OFF -DGLIDAR_DDS=ON -DGLIDAR_FOXGLOVE=ON -DGLIDAR_OPENEXR=ON)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/glidar)
vcpkg_copy_tools(TOOL_NAMES glidar AUTO_CLEAN)
file(REMOVE_RECURSE ${CURRENT_PACKAGES_DIR}/debug/include ${CURRENT_PACKAGES_DIR}/debug/share)
vcpkg_install_copyright(FILE_LIST ${SOURCE_PATH}/LICENSE)
