// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/unused_options.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/bags/bag.hpp>
#include <glidar/io/packets/packet_writer.hpp>
#include <glidar/io/packets/sensor_packets.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <variant>

namespace glidar::app {
namespace {

bool has_bag(const OutputFlags& flags) {
  return std::ranges::any_of(flags.recording_paths, bags::is_bag_name);
}

bool has_capture(const OutputFlags& flags) {
  return std::ranges::any_of(flags.recording_paths, is_capture_name);
}

template <class Predicate>
bool any_sensor(const PreparedScene& prepared, const Predicate& predicate) {
  return std::ranges::any_of(prepared.sensors, [&predicate](const ActiveSensor& active) {
    return predicate(active.sensor);
  });
}

std::string sensor_names(const PreparedScene& prepared) {
  std::string names;
  for (const ActiveSensor& active : prepared.sensors)
    names += (names.empty() ? "" : ", ") + active.sensor.name;
  return names;
}

[[noreturn]] void refuse_without_output(const char* option, const char* of, std::string allowed,
                                        const char* example) {
  throw Error(
      {.where = option,
       .found = std::string("no output has ") + of,
       .allowed = std::move(allowed),
       .remedy = std::string("add one, such as ") + example + ", or leave " + option + " out"});
}

[[noreturn]] void refuse_sensors(const char* option, const PreparedScene& prepared,
                                 const char* allowed) {
  throw Error({.where = option,
               .found = "it has no effect with " + sensor_names(prepared),
               .allowed = allowed,
               .remedy = std::string("leave ") + option + " out"});
}

/// Refuses an option of one manufacturer's packets.
void check_packets(const char* option, bool has_packet_output, bool has_sensor, const char* sensor,
                   const PreparedScene& prepared) {
  if (!has_sensor) refuse_sensors(option, prepared, sensor);
  if (!has_packet_output)
    refuse_without_output(option, "packets", "a capture (.pcap), --udp or --packet-topics",
                          "-o scan.pcap");
}

/// Options that only cameras have.
void check_camera_options(const MessageFlags& messages, const PreparedScene& prepared) {
  const auto is_camera = [](const Sensor& sensor) {
    return std::holds_alternative<Pinhole>(sensor.optics);
  };
  if (any_sensor(prepared, is_camera)) return;
  if (messages.images != ros::ImageTransport::raw)
    refuse_sensors("--image-transport", prepared, "a camera");
  if (messages.depth_in_mm) refuse_sensors("--depth-image", prepared, "a camera");
}

}  // namespace

void refuse_unused_output_options(const OutputFlags& flags, const PreparedScene& prepared,
                                  const LiveOutputs& live) {
  const bool has_messages = has_bag(flags) || live.topics;
  const bool sends_packets = has_capture(flags) || live.packets;
  const auto is_doppler = [](const Sensor& sensor) { return sensor.doppler.has_value(); };
  if (!any_sensor(prepared, is_doppler)) {
    check_columns(prepared.sensors.front().sensor, flags.columns);
  }
  const MessageFlags& messages = flags.messages;
  const std::string message_option = given_message_option(messages);
  const bool is_framed = live.viewers && !messages.frame_prefix.empty();
  if (!message_option.empty() && !has_messages && !is_framed)
    refuse_without_output(message_option.c_str(), "ROS messages", "a bag, or --ros2",
                          "-o run.mcap");
  if (messages.tf && !has_messages && !live.viewers)
    refuse_without_output("--tf", "ROS messages", "a bag, or --ros2", "-o run.mcap");
  check_camera_options(messages, prepared);
  if (messages.imu_orientation && prepared.imus.empty())
    throw Error({"--imu-orientation", "there is no IMU", "a scene file with 'imus', or --imu",
                 "leave it out"});
  if (flags.ouster_profile) {
    check_packets("--ouster-profile", sends_packets || (messages.packet_topics && has_messages),
                  any_sensor(prepared, is_ouster), "a preset of an Ouster sensor", prepared);
  }
  if (flags.livox_type) {
    check_packets("--livox-data-type", sends_packets, any_sensor(prepared, is_livox),
                  "a preset of a Livox sensor", prepared);
  }
}

void refuse_unused_imu(const RenderFlags& flags, const PreparedScene& prepared,
                       const LiveOutputs& live, PoseOrigin origin) {
  if (flags.imu.empty()) return;
  if (origin == PoseOrigin::frames) {
    throw Error({"--imu", "a simulator or ROS 2 gives the poses of frames",
                 "a motion that is known at all times", "leave --imu out"});
  }
  const OutputFlags& output = flags.output;
  const bool is_live = live.topics || live.viewers || live.record;
  if (!output.imu_paths.empty() || has_bag(output) || is_live) return;
  const bool sends_packets = has_capture(output) || live.packets;
  if (sends_packets && any_sensor(prepared, has_imu_packets)) return;
  refuse_without_output("--imu", "samples of an IMU",
                        "the suffixes .imu.csv and .imu.npz, a bag, --ros2, --foxglove, --record, "
                        "or packets of Ouster and "
                        "Livox sensors",
                        "-o run.imu.csv with --duration");
}

}  // namespace glidar::app
