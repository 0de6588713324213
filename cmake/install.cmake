# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause

# What `cmake --install` puts where, and the package that find_package(glidar) finds.
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/glidar)

get_property(layers GLOBAL PROPERTY GLIDAR_LAYER_TARGETS)
add_library(glidar_all INTERFACE)
add_library(glidar::glidar ALIAS glidar_all)
set_target_properties(glidar_all PROPERTIES EXPORT_NAME glidar)
target_link_libraries(glidar_all INTERFACE ${layers})

# Two components, as Debian divides packages: program, the default, and development.
install(TARGETS ${layers} glidar_all EXPORT glidar-targets COMPONENT development)
install(EXPORT glidar-targets FILE glidarTargets.cmake NAMESPACE glidar:: DESTINATION ${package_folder}
        COMPONENT development)

# The headers users may include are listed in one file; the others are not installed.
set(header_list ${PROJECT_SOURCE_DIR}/glidar/public_headers.txt)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${header_list})
file(STRINGS ${header_list} public_headers REGEX "^[^#]")
foreach(header IN LISTS public_headers)
  cmake_path(GET header PARENT_PATH folder)
  install(FILES ${PROJECT_SOURCE_DIR}/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder}
          COMPONENT development)
endforeach()

configure_package_config_file(cmake/glidarConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/glidarConfig.cmake
                              INSTALL_DESTINATION ${package_folder} PATH_VARS CMAKE_INSTALL_DATADIR)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/glidarConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/glidarConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/glidarConfigVersion.cmake DESTINATION ${package_folder}
        COMPONENT development)
if(NOT BUILD_SHARED_LIBS)
  install(CODE "
    include([[${PROJECT_SOURCE_DIR}/cmake/fingerprint.cmake]])
    set(file \"\${CMAKE_INSTALL_PREFIX}/${package_folder}/glidarSameSources.cmake\")
    glidar_write_same_sources(\"\$ENV{DESTDIR}\${file}\" [[${PROJECT_SOURCE_DIR}]])
    list(APPEND CMAKE_INSTALL_MANIFEST_FILES \"\${file}\")" COMPONENT development)
endif()

# The links and the commands of the installed README work in its folder: what they name is beside it,
# the data as links.
install(FILES LICENSE README.md CHANGELOG.md CITATION.cff CONTRIBUTING.md SECURITY.md packaging/copyright
        DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs examples ros2 DESTINATION ${CMAKE_INSTALL_DOCDIR}
        PATTERN "CMakeLists.txt" EXCLUDE PATTERN "__pycache__" EXCLUDE)
file(RELATIVE_PATH data_from_docs ${CMAKE_INSTALL_FULL_DOCDIR} ${CMAKE_INSTALL_FULL_DATADIR}/glidar)
foreach(folder materials models sensors)
  install(DIRECTORY ${folder} DESTINATION ${CMAKE_INSTALL_DATADIR}/glidar)
  set(link ${CMAKE_CURRENT_BINARY_DIR}/doc_links/${folder})
  file(MAKE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/doc_links)
  file(CREATE_LINK ${data_from_docs}/${folder} ${link} SYMBOLIC)
  install(FILES ${link} DESTINATION ${CMAKE_INSTALL_DOCDIR})
endforeach()
