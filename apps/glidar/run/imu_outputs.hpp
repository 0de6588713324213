// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/prepared_scene.hpp>
#include <glidar/simulate/simulate_imu.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

namespace glidar::app {

/// Throws Error if IMU samples are requested without a duration.
void check_imu_outputs(const RenderFlags& flags);

/// The samples of an IMU of the rig, by index, with from_ns <= t < until_ns. Sample 0 is at the
/// start of the run, as frame 0 of every sensor. The samples do not depend on how a time is
/// divided.
using RigImuSampler =
    std::function<ImuSamples(std::size_t imu, std::int64_t from_ns, std::int64_t until_ns)>;
RigImuSampler imu_sampler(const RenderFlags& flags, const PreparedScene& prepared);

/// Throws Error if IMU samples are requested but there is no IMU.
void check_imus(const RenderFlags& flags, const PreparedScene& prepared);

/// The end of the last frame of all sensors, or of the duration.
std::int64_t imu_end_ns(const PreparedScene& prepared);

/// Writes the samples of every IMU from the start of the run to a time, both included:
/// NAME_imu.imu.csv for NAME.imu.csv if there are several. Adds the files to `written`. Throws
/// Error.
void write_imu_outputs(const RenderFlags& flags, const PreparedScene& prepared, std::int64_t end_ns,
                       Console& console, std::vector<std::filesystem::path>& written);

}  // namespace glidar::app
