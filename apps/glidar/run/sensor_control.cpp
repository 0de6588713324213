// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/sensor_control.hpp>

#include <glidar/io/packets/hesai_codec.hpp>
#include <glidar/io/packets/hesai_packet.hpp>
#include <glidar/link/udp/udp_socket.hpp>

namespace glidar::app {
namespace {

control::OusterApiOptions ouster_api(const ServedSensor& served, const std::string& receiver) {
  OusterOptions options = served.options.ouster;
  options.identity.udp_destination = receiver;
  options.identity.lidar_port = served.route.ports.at(kOusterLidarPort);
  options.identity.imu_port = served.route.ports.at(kOusterImuPort);
  return {.metadata = ouster_metadata(served.sensor, options),
          .lidar_packet_port = kOusterLidarPort,
          .imu_packet_port = kOusterImuPort,
          .destinations = {receiver}};
}

control::PtcSensor ptc_sensor(const ServedSensor& served, const std::string& receiver,
                              const link::Endpoint& at) {
  const HesaiIdentity identity = hesai_identity(served.sensor);
  control::PtcSensor sensor;
  sensor.calibration = identity.angle_correction;
  sensor.model = identity.model_number;
  sensor.channels = identity.channels;
  sensor.return_mode = identity.return_mode;
  sensor.spin_rate_rpm = identity.spin_rate_rpm;
  sensor.packet_port = kHesaiPort;
  sensor.address = link::ipv4_text(link::resolve_udp_address(at.host, at.port));
  sensor.destination = receiver;
  sensor.destination_port = served.route.ports.at(kHesaiPort);
  sensor.destinations = {receiver};
  return sensor;
}

control::LivoxSensor livox_sensor(const ServedSensor& served, const std::string& receiver) {
  control::LivoxSensor sensor;
  sensor.data_type = static_cast<std::uint8_t>(served.options.livox_type);
  sensor.destination = receiver;
  sensor.point_port = served.route.ports.at(kLivoxPointPort);
  sensor.imu_port = served.route.ports.at(kLivoxImuPort);
  sensor.destinations = {receiver};
  return sensor;
}

}  // namespace

bool has_control(const Sensor& sensor) {
  return is_ouster(sensor) || is_hesai(sensor) || is_livox(sensor);
}

link::Endpoint default_control(const Sensor& sensor) {
  if (is_ouster(sensor)) return {.host = "127.0.0.1", .port = control::kHttpPort};
  if (is_livox(sensor)) return {.host = "127.0.0.2", .port = control::kLivoxCommandPort};
  return {.host = "127.0.0.1", .port = control::kPtcPort};
}

bool is_loopback(const std::string& host) {
  return link::ipv4_text(link::resolve_udp_address(host, 0)).starts_with("127.");
}

std::unique_ptr<control::ControlServer> serve_control(const ServedSensor& served,
                                                      const link::Endpoint& at,
                                                      link::PacketSender& sender,
                                                      link::ErrorLog& errors) {
  const std::string receiver = link::ipv4_text(link::resolve_udp_address(served.route.host, 0));
  const control::DestinationCallback redirect = [&sender](const control::Destination& to) {
    sender.redirect(to.packet_port, to.address, to.port);
  };
  if (is_ouster(served.sensor)) {
    control::OusterApiOptions api = ouster_api(served, receiver);
    api.on_destination = redirect;
    return control::serve_ouster(api, at, errors);
  }
  if (is_livox(served.sensor)) {
    control::LivoxSensor sensor = livox_sensor(served, receiver);
    sensor.on_destination = redirect;
    return control::serve_livox(sensor, at, errors);
  }
  control::PtcSensor sensor = ptc_sensor(served, receiver, at);
  sensor.on_destination = redirect;
  return control::serve_hesai(sensor, at, errors);
}

}  // namespace glidar::app
