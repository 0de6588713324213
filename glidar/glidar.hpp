// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// GLIDAR's C++ library, by subject. Single headers of this list may be included instead.

// Scenes: arrays of meshes, materials and instances; model and scene files; materials with measured
// reflectances
#include <glidar/core/scene.hpp>
#include <glidar/io/config/scene_file.hpp>
#include <glidar/io/config/surface_presets.hpp>
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/io/model/model.hpp>

// Sensors: their plain numbers, presets, files; IMUs; cameras that see a whole scene
#include <glidar/io/config/imu_file.hpp>
#include <glidar/io/config/sensor_document.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/sensor/sensor.hpp>
#include <glidar/sensor/view_placement.hpp>

// Motion of sensors and objects
#include <glidar/io/formats/trajectory_file.hpp>
#include <glidar/motion/motion.hpp>

// Simulation: frames, IMU samples, the trace of one measurement; contexts of a program's own for
// `gpu`
#include <glidar/explain/trace_text.hpp>
#include <glidar/render/gpu/gpu_renderer.hpp>
#include <glidar/render/woods2016_camera.hpp>
#include <glidar/simulate/explain.hpp>
#include <glidar/simulate/simulate_imu.hpp>
#include <glidar/simulate/simulator.hpp>

// Output: columns of a frame, files, and everything that `-o` of the program writes
#include <glidar/core/point_cloud.hpp>
#include <glidar/io/formats/file_sink.hpp>
#include <glidar/output/output.hpp>

// Images of a depth camera of the user's own: filters, alignment, stereo, time of flight,
// structured light
#include <glidar/depth_camera/depth_filters.hpp>
#include <glidar/depth_camera/stereo.hpp>
#include <glidar/depth_camera/structured_light.hpp>
#include <glidar/depth_camera/time_of_flight.hpp>
#include <glidar/sensor/depth_alignment.hpp>

// Evaluation: information about the pose, accuracy against closed forms
#include <glidar/sensor/fisher_information.hpp>
#include <glidar/verify/verify.hpp>

// The exception of every function, and the version
#include <glidar/core/error.hpp>
#include <glidar/core/version.hpp>
