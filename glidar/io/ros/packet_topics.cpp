// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/packet_topics.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/packets/velodyne_packet.hpp>

#include <algorithm>
#include <cstring>
#include <span>
#include <utility>

namespace glidar::ros {
namespace {

const PublishedPackets& packets_of(const PublishedSensor& sensor) {
  if (sensor.packets && has_packet_messages(sensor.sensor)) return *sensor.packets;
  throw Error({"packets of " + sensor.sensor.name, "no ROS driver's messages are known for them",
               "presets of Ouster and Velodyne sensors", "publish clouds only"});
}

}  // namespace

PacketTopics::PacketTopics(MessageSink& sink, const PublishedSensor& sensor,
                           const std::string& base, std::string frame_id)
    : sink_(sink),
      frame_id_(std::move(frame_id)),
      packets_(sensor.sensor, packets_of(sensor).options, packets_of(sensor).imu_samples),
      is_from_ouster_(is_ouster(sensor.sensor)),
      imu_port_(sensor.packets->options.ouster.identity.imu_port) {
  if (!is_from_ouster_) {
    packets_topic_ = sink_.add_topic(make_topic<VelodyneScan>(base + "/velodyne_packets"));
    return;
  }
  packets_topic_ = sink_.add_topic(make_topic<PacketMsg>(base + "/lidar_packets"));
  imu_topic_ = sink_.add_topic(make_topic<PacketMsg>(base + "/imu_packets"));
}

void PacketTopics::hold(const Frame& frame, const Beams& beams, HeldMessages& held) {
  packets_.encode(frame, beams, made_);
  hold_packets(held);
}

void PacketTopics::finish(HeldMessages& held) {
  packets_.finish(made_);
  hold_packets(held);
}

void PacketTopics::hold_packets(HeldMessages& held) {
  if (!is_from_ouster_) return hold_scan(held);
  for (const UdpPacket& packet : made_) {
    const std::size_t topic = packet.port == imu_port_ ? imu_topic_ : packets_topic_;
    if (!sink_.is_wanted(topic)) continue;
    PacketMsg message;
    message.buf.resize(packet.payload.size());
    std::memcpy(message.buf.data(), packet.payload.data(), packet.payload.size());
    held.hold(topic, packet.stamp_ns, message, sink_.wire());
  }
  made_.clear();
}

/// The stamp is that of the last packet: ros-drivers/velodyne, velodyne_driver.
void PacketTopics::hold_scan(HeldMessages& held) {
  VelodyneScan scan;
  scan.header.frame_id = frame_id_;
  std::int64_t last_ns = 0;
  for (const UdpPacket& packet : made_) {
    if (packet.port != kVelodynePort) continue;
    VelodynePacket stored;
    stored.stamp = time_from_ns(packet.stamp_ns);
    const std::size_t size = std::min(stored.data.size(), packet.payload.size());
    std::memcpy(stored.data.data(), packet.payload.data(), size);
    scan.packets.push_back(stored);
    last_ns = packet.stamp_ns;
  }
  made_.clear();
  if (scan.packets.empty() || !sink_.is_wanted(packets_topic_)) return;
  scan.header.stamp = time_from_ns(last_ns);
  held.hold(packets_topic_, last_ns, scan, sink_.wire());
}

}  // namespace glidar::ros
