// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/staged_files.hpp>
#include <glidar/sensor/depth_camera/fringe_measurement.hpp>

#include <span>
#include <string>
#include <vector>

namespace glidar::app {

/// Throws Error unless every name states its content: depth, coordinate, phase, modulation or
/// status, and .npy, or .png of depth and status.
void check_fringe_outputs(std::span<const std::string> paths);

/// The images of the patterns by the camera of `setup`: PNG images in their order, or one NumPy
/// array of them. Throws Error naming the file: it cannot be read, or has another size than the
/// camera, or another type than the first image.
std::vector<GreyImage> load_camera_images(std::span<const std::string> paths,
                                          const StructuredLight& setup);

/// Writes all outputs. Throws Error.
void add_fringe_files(std::span<const std::string> paths, const MeasuredFringes& measured,
                      double depth_unit_m, StagedFiles& files);

/// Writes pattern_00.png ... to a folder, which is created. Returns their names. Throws Error.
std::vector<std::string> add_patterns(const std::string& folder, const FringePatterns& patterns,
                                      StagedFiles& files);

}  // namespace glidar::app
