// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/rig_messages.hpp>

#include <apps/glidar/run/imu_outputs.hpp>
#include <apps/glidar/run/packet_setup.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/packets/sensor_packets.hpp>

#include <utility>

namespace glidar::app {
namespace {

/// The packets of all sensors with a ROS driver that publishes them.
void add_packets(const RenderFlags& flags, const PreparedScene& prepared, PoseOrigin origin,
                 ros::PublishedRig& rig) {
  bool has_packets = false;
  for (std::size_t i = 0; i < rig.sensors.size(); ++i) {
    if (!has_packet_messages(rig.sensors[i].sensor)) continue;
    rig.sensors[i].packets = packet_setup(flags, prepared, origin, prepared.sensors[i]);
    has_packets = true;
  }
  if (has_packets) return;
  throw Error({"--packet-topics", "no sensor whose ROS driver publishes packets",
               "a preset of an Ouster or Velodyne sensor", "leave it out"});
}

}  // namespace

std::unique_ptr<ros::RigPublisher> make_rig_publisher(ros::MessageSink& sink,
                                                      const RenderFlags& flags,
                                                      const PreparedScene& prepared,
                                                      PoseOrigin origin, bool for_viewers) {
  ros::PublishedRig rig{.scene = prepared.scene, .sensors = {}};
  for (const ActiveSensor& active : prepared.sensors) {
    rig.sensors.push_back({.name = active.name,
                           .sensor = active.sensor,
                           .beams = active.beams,
                           .rig_from_sensor = active.rig_from_sensor});
  }
  if (origin == PoseOrigin::motion) {
    rig.world_from_rig = prepared.motion.world_from_rig;
    for (const RigImu& imu : prepared.imus) rig.imus.push_back({imu.name, imu.rig_from_imu});
    rig.imu_samples = imu_sampler(flags, prepared);
  }
  const OutputFlags& output = flags.output;
  if (output.packet_topics && !for_viewers) add_packets(flags, prepared, origin, rig);
  return std::make_unique<ros::RigPublisher>(
      sink, std::move(rig),
      ros::RigPublisherOptions{.layout = output.sink.layout,
                               .columns = output.columns,
                               .deskew = output.deskew,
                               .images = for_viewers ? ros::ImageTransport::raw : output.images,
                               .for_viewers = for_viewers});
}

}  // namespace glidar::app
