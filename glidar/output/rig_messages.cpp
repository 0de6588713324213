// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/output/rig_messages.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/packets/sensor_packets.hpp>
#include <glidar/simulate/simulate_imu.hpp>

#include <algorithm>
#include <utility>

namespace glidar {
namespace {

/// Whether a driver publishes the packets of a sensor in any case.
bool has_driver_packets(const MessageOptions& messages, const ros::PublishedSensor& sensor) {
  return std::ranges::any_of(messages.drivers, [&sensor](const SensorDriver& choice) {
    const bool is_meant = choice.sensor_name.empty() || choice.sensor_name == sensor.name;
    return is_meant && choice.driver->has_packets;
  });
}

/// The packets of all sensors with a ROS driver that publishes them.
void add_packets(const OutputRig& from, const OutputOptions& options, ros::PublishedRig& rig) {
  const MessageOptions& messages = options.messages;
  bool has_packets = false;
  for (std::size_t i = 0; i < rig.sensors.size(); ++i) {
    ros::PublishedSensor& sensor = rig.sensors[i];
    if (!has_packet_messages(sensor.sensor)) continue;
    if (!messages.packet_topics && !has_driver_packets(messages, sensor)) continue;
    sensor.packets = packet_setup(from, options, from.sensors[i]);
    has_packets = true;
  }
  if (has_packets || !messages.packet_topics) return;
  throw Error({"--packet-topics", "no sensor whose ROS driver publishes packets",
               "a preset of an Ouster or Velodyne sensor", "leave it out"});
}

}  // namespace

ImuRun imu_run(const OutputRig& rig, std::size_t imu) {
  return {.seed = rig.seed,
          .imu = static_cast<std::uint32_t>(imu),
          .start_ns = rig.start_ns,
          .gravity_m_s2 = rig.gravity_m_s2};
}

ros::ImuSampler imu_sampler(const OutputRig& rig) {
  struct MountedImu {
    Imu imu;
    Trajectory world_from_imu;
    ImuRun run;
  };
  std::vector<MountedImu> imus;
  for (std::size_t i = 0; i < rig.imus.size(); ++i) {
    const RigImu& on_rig = rig.imus[i];
    imus.push_back({on_rig.imu, compose_extrinsic(rig.motion->world_from_rig, on_rig.rig_from_imu),
                    imu_run(rig, i)});
  }
  return [imus = std::move(imus)](std::size_t imu, std::int64_t from_ns, std::int64_t until_ns) {
    const MountedImu& mounted = imus.at(imu);
    return simulate_imu(mounted.imu, mounted.world_from_imu, mounted.run, from_ns, until_ns);
  };
}

std::size_t packet_sensor(const OutputRig& rig, const std::string& name, const std::string& where) {
  std::vector<std::size_t> found;
  std::string names;
  for (std::size_t i = 0; i < rig.sensors.size(); ++i) {
    const OutputSensor& sensor = rig.sensors[i];
    if (name.empty() ? !has_packets(sensor.sensor) : sensor.name != name) continue;
    found.push_back(i);
    names += (names.empty() ? "" : ", ") + sensor.name;
  }
  if (found.size() == 1) return found.front();
  if (found.size() > 1) {
    throw Error(
        {where, "several sensors with packets: " + names, "the packets of one sensor",
         "choose it: --sensor-name, or by its name: --udp NAME=ADDRESS; in Python give the output "
         "only this sensor"});
  }
  if (name.empty() && rig.sensors.size() == 1) return 0;  // the encoder states why
  throw Error({where, name.empty() ? "no sensor with packets" : "no sensor '" + name + "'",
               "a sensor of the rig that is a preset of Velodyne, Ouster, Hesai or Livox"});
}

ros::PublishedPackets packet_setup(const OutputRig& rig, const OutputOptions& options,
                                   const OutputSensor& sensor) {
  ros::PublishedPackets setup;
  setup.options.ouster.profile = options.ouster_profile;
  if (options.livox_type) setup.options.livox_type = *options.livox_type;
  if (!rig.motion || rig.imus.empty()) return setup;
  setup.options.ouster.sensor_from_imu =
      sensor.rig_from_sensor.inverse() * rig.imus.front().rig_from_imu;
  setup.imu_samples = [sample = imu_sampler(rig)](std::int64_t from_ns, std::int64_t until_ns) {
    return sample(0, from_ns, until_ns);
  };
  return setup;
}

std::unique_ptr<ros::RigPublisher> make_rig_publisher(ros::MessageSink& sink, const OutputRig& from,
                                                      const OutputOptions& options,
                                                      bool for_viewers) {
  ros::PublishedRig rig{.scene = from.scene, .sensors = {}};
  for (const OutputSensor& sensor : from.sensors) {
    rig.sensors.push_back({.name = sensor.name,
                           .sensor = sensor.sensor,
                           .beams = sensor.beams,
                           .rig_from_sensor = sensor.rig_from_sensor});
  }
  if (from.motion) {
    rig.world_from_rig = from.motion->world_from_rig;
    for (const RigImu& imu : from.imus) rig.imus.push_back({imu.name, imu.rig_from_imu, imu.imu});
    rig.imu_samples = imu_sampler(from);
  }
  const MessageOptions& messages = options.messages;
  if (!for_viewers) add_packets(from, options, rig);
  ros::RigPublisherOptions made{
      .layout = options.sink.layout,
      .columns = options.columns,
      .deskew = options.deskew,
      .images = for_viewers ? ros::ImageTransport::raw : messages.images,
      .has_colour = messages.has_colour,
      .depth_in_mm = messages.depth_in_mm && !for_viewers,
      .for_viewers = for_viewers,
      .has_latency = !for_viewers,
      .drivers = {},
      .transforms = {messages.tf.value_or(for_viewers ? ros::TransformMode::map
                                                      : ros::TransformMode::ground_truth),
                     messages.frame_prefix},
      .has_imu_orientation = messages.imu_orientation};
  for (const SensorDriver& choice : messages.drivers)
    made.drivers.push_back({choice.sensor_name, choice.driver});
  return std::make_unique<ros::RigPublisher>(sink, std::move(rig), std::move(made));
}

}  // namespace glidar
