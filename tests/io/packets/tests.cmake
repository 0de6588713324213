# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause

# Packets for decoders that share nothing with the encoders. Their packages conflict with others, so they have an
# environment of their own. Without it the tests report that they are skipped.
set(GLIDAR_PACKET_DECODER_PYTHON ${PROJECT_SOURCE_DIR}/build/venv-packets/bin/python
    CACHE FILEPATH "Python with the packages of scripts/requirements_packets.txt")
set(packet_python ${GLIDAR_PACKET_DECODER_PYTHON})
if(NOT EXISTS ${packet_python})
  set(packet_python ${Python3_EXECUTABLE})
endif()
add_executable(glidar_packet_files io/packets/packet_files.cpp)
target_include_directories(glidar_packet_files PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}
                                                       ${PROJECT_SOURCE_DIR})
target_link_libraries(glidar_packet_files PRIVATE glidar_settings glidar::io)
function(glidar_packet_reader name script)
  add_test(NAME "io: ${name}"
           COMMAND ${packet_python} -B ${CMAKE_CURRENT_SOURCE_DIR}/io/packets/${script} $<TARGET_FILE:glidar_packet_files>)
  set_tests_properties("io: ${name}" PROPERTIES SKIP_RETURN_CODE 77)
endfunction()
glidar_packet_reader("velodyne-decoder and ouster-sdk read packets" packet_consumers_test.py)
glidar_packet_reader("dpkt and tcpdump read captures" capture_readers_test.py)
glidar_packet_reader("grabbers of PCL read packets" pcl/pcl_grabbers_test.py)
set_property(TEST "io: grabbers of PCL read packets" PROPERTY ENVIRONMENT_MODIFICATION
             PATH=path_list_prepend:$<TARGET_FILE_DIR:glidar_app>)
find_package(PCL 1.12 QUIET COMPONENTS common io)
if(PCL_FOUND)
  add_executable(glidar_pcl_reader io/packets/pcl/pcl_reader.cpp)
  target_include_directories(glidar_pcl_reader SYSTEM PRIVATE ${PCL_INCLUDE_DIRS})
  target_compile_features(glidar_pcl_reader PRIVATE cxx_std_20)
  target_link_libraries(glidar_pcl_reader PRIVATE ${PCL_COMMON_LIBRARIES} ${PCL_IO_LIBRARIES} Threads::Threads)
  set_property(TEST "io: grabbers of PCL read packets" APPEND PROPERTY ENVIRONMENT
               GLIDAR_PCL_READER=$<TARGET_FILE:glidar_pcl_reader>)
endif()
