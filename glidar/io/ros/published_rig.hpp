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

/// Names of coordinate frames: REP-105.
inline constexpr const char* kMapFrame = "map";
inline constexpr const char* kOdometryFrame = "odom";
inline constexpr const char* kRigFrame = "base_link";
/// The frame of the ground truth, which is that of the scene.
inline constexpr const char* kGroundTruthFrame = "ground_truth";

/// How the poses of the rig are published.
enum class TransformMode : std::uint8_t {
  /// /tf has ground_truth as a child of base_link, so that base_link can have another parent, and
  /// /ground_truth/odom has the pose of base_link in ground_truth.
  ground_truth,
  odom,  ///< /tf: odom to base_link; odom is the start, level. /odom: the same (REP-105)
  map,   ///< /tf: map to base_link; /odom: the same
  none,  ///< neither these nor the transforms of sensors
};

struct TransformOptions {
  TransformMode mode = TransformMode::ground_truth;
  std::string prefix = {};  ///< of the names of all frames but map
};

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
  glidar::Imu imu = {};  ///< its errors, for covariances
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
