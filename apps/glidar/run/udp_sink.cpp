// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/udp_sink.hpp>

#include <apps/glidar/options/option_values.hpp>
#include <apps/glidar/run/packet_setup.hpp>
#include <apps/glidar/run/packet_sinks.hpp>
#include <apps/glidar/run/sensor_control.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/packets/hesai_packet.hpp>
#include <glidar/io/packets/livox_codec.hpp>
#include <glidar/io/packets/velodyne_packet.hpp>
#include <glidar/link/udp/packet_sender.hpp>

#include <chrono>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace glidar::app {
namespace {

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

}  // namespace

std::vector<std::unique_ptr<FrameSink>> make_udp_sinks(const StreamFlags& flags, double speed,
                                                       const PreparedScene& prepared,
                                                       PoseOrigin origin,
                                                       const SinkReports& reports) {
  UdpSinkMaker maker(flags, speed, prepared, origin, reports);
  std::vector<std::unique_ptr<FrameSink>> sinks;
  for (const PacketTarget& target : flags.udp) sinks.push_back(maker.make(target));
  return sinks;
}

}  // namespace glidar::app
