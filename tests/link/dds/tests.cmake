# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause

# Tests of ROS 2: in C++, with programs beside each other, and with other implementations of DDS.
glidar_tests(link/dds glidar::link)
target_sources(glidar_link_dds_tests PRIVATE fuzz/ros_poses_decoders.cpp)
if(NOT GLIDAR_HAS_CYCLONEDDS)
  return()
endif()
glidar_tests(link/dds/network glidar::link)
file(GLOB peer_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/link/dds/peer/*.cpp)
add_executable(glidar_dds_peer ${peer_sources})
target_include_directories(glidar_dds_peer PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_SOURCE_DIR})
target_link_libraries(glidar_dds_peer PRIVATE glidar_settings glidar::link fmt::fmt)
# What newer versions of Cyclone DDS announce must not end the program: those of PyPI.
set(GLIDAR_DDS_PYTHON ${PROJECT_SOURCE_DIR}/build/venv-dds/bin/python
    CACHE FILEPATH "Python with the packages of scripts/requirements_dds.txt")
set(dds_environment "GLIDAR_DDS_PEER=$<TARGET_FILE:glidar_dds_peer>")
find_package(fastrtps 2.9 QUIET)
find_package(fastdds 3 QUIET)  # its name since
if(fastrtps_FOUND OR fastdds_FOUND)
  add_executable(glidar_fastdds_reader link/dds/fastdds/fastdds_reader.cpp)
  target_link_libraries(glidar_fastdds_reader PRIVATE glidar_settings $<IF:$<TARGET_EXISTS:fastdds>,fastdds,fastrtps>)
  list(APPEND dds_environment "GLIDAR_FASTDDS_READER=$<TARGET_FILE:glidar_fastdds_reader>")
endif()
foreach(script processes_test fastdds_test stream_test)
  set_property(TEST "python: link/dds/${script}.py" APPEND PROPERTY ENVIRONMENT ${dds_environment})
endforeach()
if(EXISTS ${GLIDAR_DDS_PYTHON})
  add_test(NAME "python: link/dds/cyclonedds_test.py"
           COMMAND ${GLIDAR_DDS_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/link/dds/cyclonedds_test.py)
  set_tests_properties("python: link/dds/cyclonedds_test.py" PROPERTIES SKIP_RETURN_CODE 77
                       ENVIRONMENT "${dds_environment}"
                       ENVIRONMENT_MODIFICATION PATH=path_list_prepend:$<TARGET_FILE_DIR:glidar_app>)
else()
  glidar_skipped_test("python: link/dds/cyclonedds_test.py" "${no_venv}")
endif()
