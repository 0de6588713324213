// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/io/packets/sensor_packets.hpp>
#include <glidar/motion/motion.hpp>
#include <glidar/sensor/imu/imu_samples.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace glidar::ros {

/// The packets of a sensor, which are published beside its clouds.
struct PublishedPackets {
  PacketOptions options;
  PacketImuSampler imu_samples;
};

/// A sensor whose frames are published. Sensor and beams must outlive the publisher.
struct PublishedSensor {
  std::string name;  ///< on the rig; empty: the only sensor
  const Sensor& sensor;
  const Beams& beams;  ///< of frame 0
  Pose rig_from_sensor = Pose::Identity();
  std::optional<PublishedPackets> packets = {};
};

/// An IMU whose samples are published.
struct PublishedImu {
  std::string name;
  Pose rig_from_imu = Pose::Identity();
};

/// The samples of an IMU, by index, with from_ns <= t < until_ns.
using ImuSampler =
    std::function<ImuSamples(std::size_t imu, std::int64_t from_ns, std::int64_t until_ns)>;

/// What is published. The scene must outlive the publisher.
struct PublishedRig {
  const Scene& scene;
  std::vector<PublishedSensor> sensors;
  /// The motion of the rig; empty: known only at the times of frames, by the frames' poses.
  std::optional<Trajectory> world_from_rig = {};
  std::vector<PublishedImu> imus = {};  ///< only with world_from_rig
  ImuSampler imu_samples = {};
};

}  // namespace glidar::ros
