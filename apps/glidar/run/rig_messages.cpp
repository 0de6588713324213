// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/rig_messages.hpp>

#include <apps/glidar/run/imu_outputs.hpp>
#include <apps/glidar/run/packet_setup.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/packets/sensor_packets.hpp>

#include <algorithm>
#include <utility>

namespace glidar::app {
namespace {

/// Whether a driver of --as publishes the packets of a sensor in any case.
bool has_driver_packets(const MessageFlags& flags, const ros::PublishedSensor& sensor) {
  return std::ranges::any_of(flags.drivers, [&sensor](const DriverFlag& flag) {
    const bool is_meant = flag.sensor_name.empty() || flag.sensor_name == sensor.name;
    return is_meant && flag.driver->has_packets;
  });
}

/// The packets of all sensors with a ROS driver that publishes them.
void add_packets(const RenderFlags& flags, const PreparedScene& prepared, PoseOrigin origin,
                 ros::PublishedRig& rig) {
  const MessageFlags& messages = flags.output.messages;
  bool has_packets = false;
  for (std::size_t i = 0; i < rig.sensors.size(); ++i) {
    ros::PublishedSensor& sensor = rig.sensors[i];
    if (!has_packet_messages(sensor.sensor)) continue;
    if (!messages.packet_topics && !has_driver_packets(messages, sensor)) continue;
    sensor.packets = packet_setup(flags, prepared, origin, prepared.sensors[i]);
    has_packets = true;
  }
  if (has_packets || !messages.packet_topics) return;
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
    for (const RigImu& imu : prepared.imus)
      rig.imus.push_back({imu.name, imu.rig_from_imu, imu.imu});
    rig.imu_samples = imu_sampler(flags, prepared);
  }
  const OutputFlags& output = flags.output;
  const MessageFlags& messages = output.messages;
  if (!for_viewers) add_packets(flags, prepared, origin, rig);
  ros::RigPublisherOptions options{
      .layout = output.sink.layout,
      .columns = output.columns,
      .deskew = output.deskew,
      .images = for_viewers ? ros::ImageTransport::raw : messages.images,
      .depth_in_mm = messages.depth_in_mm && !for_viewers,
      .for_viewers = for_viewers,
      .has_latency = !for_viewers,
      .drivers = {},
      .transforms = {messages.tf.value_or(for_viewers ? ros::TransformMode::map
                                                      : ros::TransformMode::ground_truth),
                     messages.frame_prefix},
      .has_imu_orientation = messages.imu_orientation};
  for (const DriverFlag& flag : messages.drivers)
    options.drivers.push_back({flag.sensor_name, flag.driver});
  return std::make_unique<ros::RigPublisher>(sink, std::move(rig), std::move(options));
}

}  // namespace glidar::app
