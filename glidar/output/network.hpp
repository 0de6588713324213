// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/dds/message_sink.hpp>
#include <glidar/link/endpoint.hpp>
#include <glidar/link/error_log.hpp>
#include <glidar/output/output.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glidar {

/// A receiver of packets: [SENSOR=]ADDRESS[:PORT[:PORT]].
struct PacketTarget {
  std::string sensor_name;  ///< empty: the only sensor with packets
  std::string host;
  std::optional<std::uint16_t> data_port;    ///< empty: the manufacturer's
  std::optional<std::uint16_t> second_port;  ///< of positions (Velodyne) or IMU (Ouster, Livox)
};

/// Throws Error when the text is not one.
PacketTarget parse_packet_target(const std::string& text);

/// Where the drivers of a sensor reach it: [SENSOR=]ADDRESS[:PORT].
struct ControlTarget {
  std::string sensor_name;  ///< empty: all
  std::string host;
  std::optional<std::uint16_t> port;  ///< empty: the manufacturer's
};

/// Where the drivers of sensors reach them.
struct PacketControl {
  std::vector<ControlTarget> chosen = {};  ///< empty: at loopback addresses
  bool has_none = false;                   ///< nowhere
};

/// How the drivers of a sensor reach it.
struct ControlPlan {
  std::optional<link::Endpoint> at;  ///< empty: they do not
  bool is_chosen = false;            ///< by PacketControl::chosen
};

/// Throws Error when an address is chosen for a sensor whose drivers only receive packets.
ControlPlan control_plan(const PacketControl& control, const OutputSensor& sensor,
                         const PacketTarget& target);

/// Sends the packets of a sensor by UDP. `speed`: how fast the time of the frames passes; 0:
/// packets are sent at once. `control`: serves the drivers of the sensor there. The log must
/// outlive it. Throws Error.
std::unique_ptr<Output> open_packet_output(const PacketTarget& target, const OutputRig& rig,
                                           const OutputOptions& options, double speed,
                                           link::ErrorLog& errors,
                                           const std::optional<link::Endpoint>& control = {});

/// Publishes the messages of all frames as topics of ROS 2. `speed` as for open_packet_output().
/// The participant must outlive it. Throws Error.
std::unique_ptr<Output> open_ros2_output(const dds::Participant& participant,
                                         dds::MessageSinkOptions topics, const OutputRig& rig,
                                         const OutputOptions& options, double speed);

/// Whether the name is that of a network, not of a file: udp:// or ros2://.
bool is_url(const std::string& path);

/// Opens udp://[SENSOR=]ADDRESS[:PORT[:PORT]] or ros2://[NAMESPACE], see open_output().
std::unique_ptr<Output> open_url(const std::string& url, const OutputRig& rig,
                                 const OutputOptions& options, const Report& report);

}  // namespace glidar
