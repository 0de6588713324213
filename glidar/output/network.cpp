// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/output/network.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/option_name.hpp>
#include <glidar/io/packets/hesai.hpp>
#include <glidar/io/packets/livox.hpp>
#include <glidar/io/packets/sensor_packets.hpp>
#include <glidar/io/packets/velodyne.hpp>
#include <glidar/link/control/control_server.hpp>
#include <glidar/link/dds/participant.hpp>
#include <glidar/link/udp/packet_sender.hpp>
#include <glidar/output/rig_messages.hpp>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace glidar {
namespace {

constexpr std::string_view kUdp = "udp://";
constexpr std::string_view kRos2 = "ros2://";

struct ServedSensor {
  const Sensor& sensor;
  const PacketOptions& options;
  const link::PacketRoute& route;  ///< of its packets at the start
};

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

/// Serves the drivers of a sensor, which may redirect the packets of this sender. Sender and log
/// must outlive it. Throws Error.
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

class PacketOutput final : public Output {
 public:
  PacketOutput(std::size_t sensor_index, const Sensor& sensor, const ros::PublishedPackets& setup,
               std::unique_ptr<link::PacketSender> sender)
      : sensor_index_(sensor_index),
        sensor_(sensor),
        hit_columns_(hit_columns_for(packet_columns(setup.options))),
        packets_(sensor, setup.options, setup.imu_samples),
        sender_(std::move(sender)) {}

  /// The sensor's interface for drivers, which redirects the packets of sender().
  void serve_drivers(std::unique_ptr<control::ControlServer> server) {
    server_ = std::move(server);
  }
  [[nodiscard]] link::PacketSender& sender() { return *sender_; }

  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor) const override {
    return sensor == sensor_index_ ? hit_columns_ : HitColumnMask{};
  }
  void write(const RigFrame& written) override {
    if (written.sensor != sensor_index_) return;
    std::vector<UdpPacket> made;
    packets_.encode(written.frame, written.beams, made);
    sender_->send(std::move(made), written.frame.stamp_ns);
    const FrameInterval interval = frame_interval(sensor_, written.frame.number);
    end_ns_ = written.frame.stamp_ns + (interval.end_ns - interval.start_ns);
  }
  void finish() override {
    constexpr std::chrono::milliseconds kMaxDelay{200};  // SIGTERM ends the program soon
    std::vector<UdpPacket> made;
    packets_.finish(made);
    if (!made.empty()) sender_->send(std::move(made), end_ns_);
    sender_->finish(kMaxDelay);
  }

 private:
  std::size_t sensor_index_;
  Sensor sensor_;
  HitColumnMask hit_columns_;
  SensorPackets packets_;
  std::unique_ptr<link::PacketSender> sender_;
  std::unique_ptr<control::ControlServer> server_;  ///< ends before the sender
  std::int64_t end_ns_ = 0;                         ///< of the last frame
};

/// Two kinds of packets: data, and the position of Velodyne or the IMU of Ouster and Livox.
link::PacketRoute route_of(const PacketTarget& target, const Sensor& sensor) {
  std::uint16_t data = kVelodynePort;
  std::uint16_t second = kVelodynePositionPort;
  static_assert(kHesaiPort == kVelodynePort);
  if (is_ouster(sensor)) {
    data = kOusterLidarPort;
    second = kOusterImuPort;
  } else if (is_livox(sensor)) {
    data = kLivoxPointPort;
    second = kLivoxImuPort;
  }
  return {.host = target.host,
          .ports = {{data, target.data_port.value_or(data)},
                    {second, target.second_port.value_or(second)}}};
}

/// Whether the drivers of the sensor read from it before they receive packets: HTTP of Ouster, PTC
/// of Hesai, commands of Livox.
bool has_control(const Sensor& sensor) {
  return is_ouster(sensor) || is_hesai(sensor) || is_livox(sensor);
}

/// The address that they use unless another one is chosen. That of Livox differs from that of the
/// receiver, because its SDK ignores packets from its own address.
link::Endpoint default_control(const Sensor& sensor) {
  if (is_ouster(sensor)) return {.host = "127.0.0.1", .port = control::kHttpPort};
  if (is_livox(sensor)) return {.host = "127.0.0.2", .port = control::kLivoxCommandPort};
  return {.host = "127.0.0.1", .port = control::kPtcPort};
}

/// Whether a host is this machine. Throws Error when it is not known.
bool is_loopback(const std::string& host) {
  return link::ipv4_text(link::resolve_udp_address(host, 0)).starts_with("127.");
}

/// Refuses "::1" and "[::1]:2368".
void refuse_ipv6(const std::string& text) {
  constexpr std::ptrdiff_t kMaxColons = 2;  // before two ports
  const bool has_dots = text.find('.') != std::string::npos;
  const bool is_ipv6 = text.find('[') != std::string::npos ||
                       text.find("::") != std::string::npos ||
                       (!has_dots && std::count(text.begin(), text.end(), ':') > kMaxColons);
  if (!is_ipv6) return;
  throw Error({"", "'" + text + "', an IPv6 address",
               "[SENSOR=]ADDRESS[:PORT[:PORT]] with an IPv4 address or the name of a host",
               "for example 127.0.0.1:2368"});
}

/// Takes the first port out of ADDRESS[:PORT[:PORT]]; empty: there is none.
std::optional<std::uint16_t> take_port(std::string& rest) {
  const std::size_t colon = rest.find(':');
  if (colon == std::string::npos) return std::nullopt;
  const std::size_t end = std::min(rest.find(':', colon + 1), rest.size());
  const std::string text = rest.substr(colon + 1, end - colon - 1);
  std::uint16_t port = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  if (error != std::errc() || stop != text.data() + text.size() || port == 0)
    throw Error({"", "'" + text + "'", "a whole number from 1 to 65535"});
  rest.erase(colon, end - colon);
  return port;
}

/// Publishes the messages of all frames as topics of ROS 2.
class Ros2Output final : public Output {
 public:
  Ros2Output(const dds::Participant& participant, dds::MessageSinkOptions topics,
             const OutputRig& rig, const OutputOptions& options, double speed)
      : topics_(participant, std::move(topics)),
        publisher_(make_rig_publisher(topics_, rig, options)),
        speed_(speed) {}

  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor) const override {
    return publisher_->hit_columns(sensor);
  }
  void write(const RigFrame& written) override {
    publisher_->publish(written.sensor, written.frame, written.beams);
    last_due_ = written.due;
    last_stamp_ns_ = written.frame.stamp_ns;
  }
  /// Publishes poses and samples of IMUs at their times.
  void serve() override {
    topics_.report_other_publishers();
    if (!last_due_ || speed_ <= 0.0) return;
    const std::chrono::duration<double, std::nano> passed =
        std::chrono::steady_clock::now() - *last_due_;
    publisher_->advance(last_stamp_ns_ + std::llround(speed_ * passed.count()));
  }
  [[nodiscard]] std::chrono::milliseconds serve_interval() const override {
    constexpr std::chrono::milliseconds kPaced{2};  // IMUs have hundreds of samples per second
    return speed_ > 0.0 ? kPaced : kServeInterval;
  }
  void finish() override {
    publisher_->finish();
    topics_.finish();
  }

 private:
  dds::MessageSink topics_;
  std::unique_ptr<ros::RigPublisher> publisher_;
  double speed_;
  std::optional<std::chrono::steady_clock::time_point> last_due_;  ///< of the last frame
  std::int64_t last_stamp_ns_ = 0;                                 ///< of the last frame
};

/// An output of a network with the connection that it needs, whose errors go to a report.
class Connected final : public Output {
 public:
  explicit Connected(const Report& report) : errors_(report) {}
  void send_packets(const std::string& receiver, const OutputRig& rig,
                    const OutputOptions& options) {
    output_ = open_packet_output(parse_packet_target(receiver), rig, options, 0.0, errors_);
  }
  void publish(const std::string& ros_namespace, const OutputRig& rig,
               const OutputOptions& options) {
    participant_ = std::make_unique<dds::Participant>(dds::DomainOptions{}, errors_);
    output_ = open_ros2_output(*participant_, {.ros_namespace = ros_namespace}, rig, options, 0.0);
  }

  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor) const override {
    return output_->hit_columns(sensor);
  }
  void write(const RigFrame& written) override {
    output_->write(written);
    output_->serve();
  }
  void finish() override {
    output_->finish();
    errors_.flush();
  }

 private:
  link::ErrorLog errors_;
  std::unique_ptr<dds::Participant> participant_;
  std::unique_ptr<Output> output_;
};

}  // namespace

PacketTarget parse_packet_target(const std::string& text) {
  refuse_ipv6(text);
  PacketTarget target;
  const std::size_t equals = text.find('=');
  if (equals != std::string::npos) target.sensor_name = text.substr(0, equals);
  std::string rest = equals == std::string::npos ? text : text.substr(equals + 1);
  target.data_port = take_port(rest);
  target.second_port = take_port(rest);
  target.host = rest;
  if (!rest.empty() && rest.find(':') == std::string::npos && equals != 0) return target;
  throw Error(
      {"", "'" + text + "'", "[SENSOR=]ADDRESS[:PORT[:PORT]]", "for example 127.0.0.1:2368"});
}

ControlPlan control_plan(const PacketControl& control, const OutputSensor& sensor,
                         const PacketTarget& target) {
  if (control.has_none) return {};
  const bool has_one = has_control(sensor.sensor);
  for (const ControlTarget& chosen : control.chosen) {
    if (!chosen.sensor_name.empty() && chosen.sensor_name != sensor.name) continue;
    if (!has_one && chosen.sensor_name == sensor.name)
      throw Error({"--control", sensor.sensor.name + ", whose drivers only receive packets",
                   "sensors of Ouster, Hesai and Livox", "leave it out"});
    if (!has_one) continue;
    const std::uint16_t port = chosen.port.value_or(default_control(sensor.sensor).port);
    return {link::Endpoint{.host = chosen.host, .port = port}, true};
  }
  // packets of Livox leave from the sensor's address, and none from loopback to another machine
  if (!has_one || (is_livox(sensor.sensor) && !is_loopback(target.host))) return {};
  return {default_control(sensor.sensor), false};
}

std::unique_ptr<Output> open_packet_output(const PacketTarget& target, const OutputRig& rig,
                                           const OutputOptions& options, double speed,
                                           link::ErrorLog& errors,
                                           const std::optional<link::Endpoint>& control) {
  const std::size_t index = packet_sensor(rig, target.sensor_name, "packets by UDP");
  const Sensor& sensor = rig.sensors[index].sensor;
  const ros::PublishedPackets setup = packet_setup(rig, options, rig.sensors[index]);
  link::PacketRoute route = route_of(target, sensor);
  if (control && is_livox(sensor)) {
    route.source = control->host;
    route.source_ports = {kLivoxPointSourcePort, kLivoxImuSourcePort};
  }
  auto output = std::make_unique<PacketOutput>(
      index, sensor, setup, std::make_unique<link::PacketSender>(route, speed, errors));
  if (control) {
    output->serve_drivers(
        serve_control({sensor, setup.options, route}, *control, output->sender(), errors));
  }
  return output;
}

std::unique_ptr<Output> open_ros2_output(const dds::Participant& participant,
                                         dds::MessageSinkOptions topics, const OutputRig& rig,
                                         const OutputOptions& options, double speed) {
  return std::make_unique<Ros2Output>(participant, std::move(topics), rig, options, speed);
}

bool is_url(const std::string& path) {
  return path.starts_with(kUdp) || path.starts_with(kRos2);
}

std::unique_ptr<Output> open_url(const std::string& url, const OutputRig& rig,
                                 const OutputOptions& options, const Report& report) {
  auto output = std::make_unique<Connected>(report);
  with_option_name(url, [&] {
    if (url.starts_with(kUdp)) {
      output->send_packets(url.substr(kUdp.size()), rig, options);
    } else {
      output->publish(url.substr(kRos2.size()), rig, options);
    }
  });
  return output;
}

}  // namespace glidar
