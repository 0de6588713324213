// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/ros.

#include <glidar/io/packets/sensor_packets.hpp>
#include <glidar/io/ros/held_messages.hpp>
#include <glidar/io/ros/message_sink.hpp>
#include <glidar/io/ros/published_rig.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace glidar::ros {

/// Publishes the packets of a sensor as the driver of its manufacturer does: those of Ouster one by
/// one, and those of Velodyne as a VelodyneScan for each frame.
class PacketTopics {
 public:
  /// Adds the topics to the sink, which must outlive it. `base` is before the names of all topics.
  /// Throws Error when the sensor has no packets of these manufacturers.
  PacketTopics(MessageSink& sink, const PublishedSensor& sensor, const std::string& base,
               std::string frame_id);

  /// Adds the packets that a frame completes to the messages that are to be written.
  void hold(const Frame& frame, const Beams& beams, HeldMessages& held);
  /// The same for the last packet, filled with firings without returns.
  void finish(HeldMessages& held);

 private:
  void hold_packets(HeldMessages& held);
  void hold_scan(HeldMessages& held);

  MessageSink& sink_;
  std::string frame_id_;
  SensorPackets packets_;
  bool is_from_ouster_;
  std::uint16_t imu_port_;
  std::size_t packets_topic_ = 0;
  std::size_t imu_topic_ = 0;  ///< Ouster
  std::vector<UdpPacket> made_;
};

}  // namespace glidar::ros
