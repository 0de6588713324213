// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to the library and the program: calibrations of single sensors, in the files of their
// manufacturers and of calibration programs.

#include <glidar/sensor/sensor.hpp>

#include <filesystem>

namespace glidar {

/// Replaces the numbers of a sensor by those of its calibration, and adds notes about what is not
/// used. The content decides which kind of file it is. For a spinning LiDAR:
///  - metadata JSON of an Ouster sensor: all of the optics;
///  - calibration YAML of velodyne_pointcloud (ros-drivers/velodyne): angles, beam origins and
///    distance corrections of the lasers;
///  - angle correction CSV of Hesai: "Channel,Elevation,Azimuth", degrees, azimuths clockwise;
///  - firing time CSV of Hesai: "Channel,fire time(us)", or one column per firing loop.
/// For a camera:
///  - camchain YAML of Kalibr, of which "FILE#cam1" selects a camera, by default cam0;
///  - camera YAML of ROS (camera_calibration_parsers).
/// Throws Error with the place in the file, or when the sensor has another number of channels.
void apply_calibration(const std::filesystem::path& path, Sensor& sensor);

}  // namespace glidar
