// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/packets/sensor_packets.hpp>
#include <glidar/link/control/control_server.hpp>
#include <glidar/link/endpoint.hpp>
#include <glidar/link/error_log.hpp>
#include <glidar/link/udp/packet_sender.hpp>

#include <memory>
#include <string>

namespace glidar::app {

/// Whether the drivers of the sensor read from it before they receive packets: HTTP of Ouster, PTC
/// of Hesai, commands of Livox.
bool has_control(const Sensor& sensor);

/// The address that they use unless another one is chosen. That of Livox differs from that of the
/// receiver, because its SDK ignores packets from its own address.
link::Endpoint default_control(const Sensor& sensor);

/// Whether a host is this machine. Throws Error when it is not known.
bool is_loopback(const std::string& host);

struct ServedSensor {
  const Sensor& sensor;
  const PacketOptions& options;
  const link::PacketRoute& route;  ///< of its packets at the start
};

/// Serves the drivers of a sensor, which may redirect the packets of this sender. Sender and log
/// must outlive it. Throws Error.
std::unique_ptr<control::ControlServer> serve_control(const ServedSensor& served,
                                                      const link::Endpoint& at,
                                                      link::PacketSender& sender,
                                                      link::ErrorLog& errors);

}  // namespace glidar::app
