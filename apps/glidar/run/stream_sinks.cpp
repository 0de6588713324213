// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/stream_sinks.hpp>

#include <apps/glidar/options/option_values.hpp>
#include <apps/glidar/options/stream_options.hpp>
#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/frame_sink.hpp>
#include <apps/glidar/run/imu_outputs.hpp>
#include <apps/glidar/run/packet_setup.hpp>
#include <apps/glidar/run/packet_sinks.hpp>
#include <apps/glidar/run/recording_sinks.hpp>
#include <apps/glidar/run/rig_messages.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/packets/hesai_codec.hpp>
#include <glidar/io/packets/hesai_packet.hpp>
#include <glidar/io/packets/livox_codec.hpp>
#include <glidar/io/packets/sensor_packets.hpp>
#include <glidar/io/packets/velodyne_packet.hpp>
#include <glidar/link/control/control_server.hpp>
#include <glidar/link/endpoint.hpp>
#include <glidar/link/error_log.hpp>
#include <glidar/link/udp/packet_sender.hpp>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace glidar::app {
namespace {

class ImuSink final : public FrameSink {
 public:
  ImuSink(const RenderFlags& flags, const PreparedScene& prepared, Console& console)
      : flags_(flags), prepared_(prepared), console_(console) {}

  [[nodiscard]] HitColumnMask hit_columns(std::size_t /*sensor_index*/) const override {
    return {};
  }
  void write(const MeasuredFrame& measured) override {
    const Sensor& sensor = prepared_.sensors[measured.sensor_index].sensor;
    const FrameInterval interval = frame_interval(sensor, measured.frame.number);
    const std::int64_t end_ns = measured.frame.stamp_ns + (interval.end_ns - interval.start_ns);
    end_ns_ = std::max(end_ns_.value_or(end_ns), end_ns);
  }
  void finish() override {
    std::vector<std::filesystem::path> written;
    if (end_ns_) write_imu_outputs(flags_, prepared_, *end_ns_, console_, written);
  }

 private:
  const RenderFlags& flags_;
  const PreparedScene& prepared_;
  Console& console_;
  std::optional<std::int64_t> end_ns_;  ///< of the last frame
};

/// The samples of all IMUs until the end of the last frame, in the files of the flags, which must
/// outlive it like the scene. Throws Error when there is no IMU, or when the motion is not known.
std::unique_ptr<FrameSink> make_imu_sink(const RenderFlags& flags, const PreparedScene& prepared,
                                         PoseOrigin origin, Console& console) {
  check_imus(flags, prepared);
  if (origin == PoseOrigin::frames) {
    throw Error({"--output, " + flags.output.imu_paths.front(),
                 "samples of IMUs, but a simulator or a client gives the poses of frames",
                 "a motion that is known at all times", "leave it out"});
  }
  return std::make_unique<ImuSink>(flags, prepared, console);
}

/// Where errors of peers, and what the user should know, are reported.
struct SinkReports {
  link::ErrorLog& errors;
  Console& console;
};

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

class UdpSink final : public FrameSink {
 public:
  UdpSink(std::size_t sensor_index, const Sensor& sensor, const ros::PublishedPackets& setup,
          std::unique_ptr<link::PacketSender> sender)
      : sensor_index_(sensor_index),
        sensor_(sensor),
        packets_(sensor, setup.options, setup.imu_samples),
        sender_(std::move(sender)) {}

  /// The sensor's interface for drivers, which redirects the packets of sender().
  void serve_drivers(std::unique_ptr<control::ControlServer> server) {
    server_ = std::move(server);
  }
  [[nodiscard]] link::PacketSender& sender() { return *sender_; }

  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor_index) const override {
    return sensor_index == sensor_index_ ? hit_columns_for(packet_columns()) : HitColumnMask{};
  }
  void write(const MeasuredFrame& measured) override {
    if (measured.sensor_index != sensor_index_) return;
    std::vector<UdpPacket> made;
    packets_.encode(measured.frame, *measured.beams, made);
    sender_->send(std::move(made), measured.frame.stamp_ns);
    const FrameInterval interval = frame_interval(sensor_, measured.frame.number);
    end_ns_ = measured.frame.stamp_ns + (interval.end_ns - interval.start_ns);
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
  SensorPackets packets_;
  std::unique_ptr<link::PacketSender> sender_;
  std::unique_ptr<control::ControlServer> server_;  ///< ends before the sender
  std::int64_t end_ns_ = 0;                         ///< of the last frame
};

/// How the drivers of a sensor reach it.
struct ControlPlan {
  std::optional<link::Endpoint> at;  ///< empty: they do not
  bool is_chosen = false;            ///< by --control
};

ControlPlan control_plan(const StreamFlags& flags, const ActiveSensor& active,
                         const PacketTarget& target) {
  if (flags.has_no_control) return {};
  const bool has_one = has_control(active.sensor);
  for (const ControlTarget& chosen : flags.control) {
    if (!chosen.sensor_name.empty() && chosen.sensor_name != active.name) continue;
    if (!has_one && chosen.sensor_name == active.name)
      throw Error({"--control", active.sensor.name + ", whose drivers only receive packets",
                   "sensors of Ouster, Hesai and Livox", "leave it out"});
    if (!has_one) continue;
    const std::uint16_t port = chosen.port.value_or(default_control(active.sensor).port);
    return {link::Endpoint{.host = chosen.host, .port = port}, true};
  }
  // packets of Livox leave from the sensor's address, and none from loopback to another machine
  if (!has_one || (is_livox(active.sensor) && !is_loopback(target.host))) return {};
  return {default_control(active.sensor), false};
}

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

/// Makes the sinks of one stream.
class UdpSinkMaker {
 public:
  UdpSinkMaker(const StreamFlags& flags, double speed, const PreparedScene& prepared,
               PoseOrigin origin, const SinkReports& reports)
      : flags_(flags), speed_(speed), prepared_(prepared), origin_(origin), reports_(reports) {}

  std::unique_ptr<FrameSink> make(const PacketTarget& target) {
    Selection selected;
    with_option_name("--udp", [&] { selected = select(target); });
    if (const std::optional<link::Endpoint>& at = selected.plan.at) {
      try {
        return serving(selected, *at);
      } catch (const Error& error) {
        if (selected.plan.is_chosen) throw;
        reports_.console.warn(std::string("drivers cannot reach the sensor: ") + error.what() +
                              "; choose an address with --control, or none");
      }
    }
    std::unique_ptr<UdpSink> sink;
    with_option_name("--udp", [&] { sink = plain(selected); });
    return sink;
  }

 private:
  struct Selection {
    std::size_t index = 0;
    ros::PublishedPackets setup;
    link::PacketRoute route;
    ControlPlan plan;
  };

  Selection select(const PacketTarget& target) {
    Selection selected;
    selected.index = packet_sensor(prepared_, target.sensor_name, "--udp");
    const ActiveSensor& active = prepared_.sensors[selected.index];
    selected.setup = packet_setup(flags_.render, prepared_, origin_, active);
    selected.route = route_of(target, active.sensor);
    const bool is_first = served_.insert(selected.index).second;
    if (is_first) selected.plan = control_plan(flags_, active, target);
    return selected;
  }

  std::unique_ptr<UdpSink> plain(const Selection& selected) {
    return std::make_unique<UdpSink>(
        selected.index, prepared_.sensors[selected.index].sensor, selected.setup,
        std::make_unique<link::PacketSender>(selected.route, speed_, reports_.errors));
  }

  std::unique_ptr<UdpSink> serving(Selection selected, const link::Endpoint& at) {
    const Sensor& sensor = prepared_.sensors[selected.index].sensor;
    if (is_livox(sensor)) {
      selected.route.source = at.host;
      selected.route.source_ports = {kLivoxPointSourcePort, kLivoxImuSourcePort};
    }
    std::unique_ptr<UdpSink> sink;
    with_option_name("--control", [&] {
      sink = plain(selected);
      sink->serve_drivers(serve_control({sensor, selected.setup.options, selected.route}, at,
                                        sink->sender(), reports_.errors));
    });
    return sink;
  }

  const StreamFlags& flags_;
  double speed_;
  const PreparedScene& prepared_;
  PoseOrigin origin_;
  SinkReports reports_;
  std::set<std::size_t> served_;
};

/// Sends the packets of sensors by UDP, as --udp selects them, and serves the drivers of each
/// sensor once. `speed`: how fast the time of the frames passes; 0: packets are sent at once. Flags
/// and reports must outlive them. Throws Error.
std::vector<std::unique_ptr<FrameSink>> make_udp_sinks(const StreamFlags& flags, double speed,
                                                       const PreparedScene& prepared,
                                                       PoseOrigin origin,
                                                       const SinkReports& reports) {
  UdpSinkMaker maker(flags, speed, prepared, origin, reports);
  std::vector<std::unique_ptr<FrameSink>> sinks;
  for (const PacketTarget& target : flags.udp) sinks.push_back(maker.make(target));
  return sinks;
}

}  // namespace

PoseOrigin pose_origin(const StreamFlags& flags) {
  return has_pose_source(flags) || flags.replays_requests ? PoseOrigin::frames : PoseOrigin::motion;
}

double time_speed(const StreamFlags& flags, const Sensor& first_sensor) {
  if (flags.replay.empty()) return has_pose_source(flags) || flags.is_unpaced ? 0.0 : 1.0;
  if (flags.replay_rate_hz) return *flags.replay_rate_hz / first_sensor.rate_hz;
  return flags.foxglove ? 1.0 : 0.0;
}

std::vector<std::unique_ptr<FrameSink>> make_stream_sinks(const StreamFlags& flags,
                                                          const PreparedScene& prepared,
                                                          const std::vector<std::string>& read,
                                                          link::ErrorLog& errors,
                                                          Console& console) {
  const PoseOrigin origin = pose_origin(flags);
  std::vector<std::unique_ptr<FrameSink>> sinks =
      make_recording_sinks(flags.render, prepared, read, origin);
  if (!flags.render.output.imu_paths.empty()) {
    sinks.push_back(make_imu_sink(flags.render, prepared, origin, console));
  }
  const double speed = time_speed(flags, prepared.sensors.front().sensor);
  for (auto& sink : make_udp_sinks(flags, speed, prepared, origin, {errors, console})) {
    sinks.push_back(std::move(sink));
  }
  return sinks;
}

std::chrono::milliseconds serve_interval(const std::vector<std::unique_ptr<FrameSink>>& sinks) {
  std::chrono::milliseconds interval = kDefaultServeInterval;
  for (const auto& sink : sinks) interval = std::min(interval, sink->serve_interval());
  return interval;
}

HitColumnMask needed_hit_columns(const std::vector<std::unique_ptr<FrameSink>>& sinks,
                                 std::size_t sensor_count) {
  HitColumnMask needed;
  for (const auto& sink : sinks) {
    for (std::size_t i = 0; i < sensor_count; ++i) {
      needed = needed | sink->hit_columns(i);
    }
  }
  return needed;
}

}  // namespace glidar::app
