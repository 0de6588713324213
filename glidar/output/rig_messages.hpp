// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/rig_publisher.hpp>
#include <glidar/output/output.hpp>

#include <cstddef>
#include <memory>
#include <string>

namespace glidar {

/// The samples of the IMUs of a rig with a motion. Sample 0 is at the start of the run, as frame 0
/// of every sensor. The samples do not depend on how a time is divided.
ros::ImuSampler imu_sampler(const OutputRig& rig);

/// How an IMU of the rig is simulated.
ImuRun imu_run(const OutputRig& rig, std::size_t imu);

/// Index of the sensor of this name, or of the only one that has packets; `where` is for errors.
/// Throws Error when there is none, or several.
std::size_t packet_sensor(const OutputRig& rig, const std::string& name, const std::string& where);

/// Packets of a sensor of the rig, with the samples of its first IMU.
ros::PublishedPackets packet_setup(const OutputRig& rig, const OutputOptions& options,
                                   const OutputSensor& sensor);

/// The publisher of the rig's messages. The sink must outlive it. Throws Error.
std::unique_ptr<ros::RigPublisher> make_rig_publisher(ros::MessageSink& sink, const OutputRig& rig,
                                                      const OutputOptions& options,
                                                      bool for_viewers = false);

}  // namespace glidar
