# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause

# Two Debian packages from one build (`./dev package`, preset package): glidar is the program with its
# data and documentation, libglidar-dev is what find_package(glidar) finds.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME glidar)
set(CPACK_PACKAGE_CONTACT "The GLIDAR developers" CACHE STRING "Maintainer of the package: NAME <MAIL>")
set(CPACK_PACKAGE_HOMEPAGE_URL "${PROJECT_HOMEPAGE_URL}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ
                                                GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

# What the program opens by name when it draws is no library that dpkg-shlibdeps sees.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME glidar)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "libegl1, libgl1, libopengl0, libgl1-mesa-dri")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION [[
GLIDAR simulates LiDARs and depth cameras: it renders the point cloud, the
depth images and the intensity that a sensor would measure of a 3D model, with
the ground truth of every value.
.
'glidar campaign' also needs the Python package glidar[campaign], which this
package does not contain: make a wheel with './dev wheel' in GLIDAR's source
and install it with pip.]])

# The static libraries leave their own dependencies to whoever links them (glidarConfig.cmake).
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libglidar-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libeigen3-dev, libtbb-dev, libyaml-cpp-dev, libfmt-dev, libpng-dev, libzip-dev, \
liblzf-dev, liblz4-dev, libzstd-dev, libsqlite3-dev, zlib1g-dev, libtiff-dev, libxxhash-dev, libepoxy-dev, libzmq3-dev, pkg-config")
if(GLIDAR_HAS_OPENEXR)
  string(APPEND CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS ", libopenexr-dev")
endif()
if(GLIDAR_HAS_CYCLONEDDS)
  string(APPEND CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS ", cyclonedds-dev")
endif()
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "g++, cmake")
set(CPACK_COMPONENT_DEVELOPMENT_DEPENDS program)  # models are read by its helper program
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION [[
Headers, static libraries and the CMake package of GLIDAR for C++:
find_package(glidar), target_link_libraries(... glidar::glidar).]])
if(GLIDAR_FOR_PACKAGE)
  install(FILES packaging/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libglidar-dev
          COMPONENT development)
endif()
include(CPack)
