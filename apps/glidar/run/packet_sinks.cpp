// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/packet_sinks.hpp>

#include <apps/glidar/run/imu_outputs.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/packets/hesai_packet.hpp>
#include <glidar/io/packets/packet_writer.hpp>
#include <glidar/io/packets/velodyne_packet.hpp>
#include <glidar/link/udp/packet_sender.hpp>

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

namespace glidar::app {
namespace {

const std::vector<std::string> kPacketColumns = {"xyz", "intensity", "range"};

/// The sensor of this name, or the only one that has packets.
std::size_t packet_sensor(const PreparedScene& prepared, const std::string& name,
                          const std::string& where) {
  std::vector<std::size_t> found;
  std::string names;
  for (std::size_t i = 0; i < prepared.sensors.size(); ++i) {
    const ActiveSensor& active = prepared.sensors[i];
    if (name.empty() ? !has_packets(active.sensor) : active.name != name) continue;
    found.push_back(i);
    names += (names.empty() ? "" : ", ") + active.name;
  }
  if (found.size() == 1) return found.front();
  if (found.size() > 1) {
    throw Error({where, "several sensors with packets: " + names, "the packets of one sensor",
                 "choose it with --sensor-name, or by its name: --udp NAME=ADDRESS"});
  }
  if (name.empty() && prepared.sensors.size() == 1) return 0;  // the encoder states why
  throw Error({where, name.empty() ? "no sensor with packets" : "no sensor '" + name + "'",
               "a sensor of the rig that is a preset of Velodyne, Ouster or Hesai"});
}

/// Packets as the flags select them, with the samples of the rig's first IMU.
struct PacketSetup {
  PacketOptions options;
  PacketImuSampler imu_samples;
};

PacketSetup setup_of(const RenderFlags& flags, const PreparedScene& prepared, PoseOrigin origin,
                     const ActiveSensor& active) {
  PacketSetup setup;
  setup.options.ouster.profile = flags.output.ouster_profile;
  if (origin != PoseOrigin::motion || prepared.imus.empty()) return setup;
  setup.options.ouster.sensor_from_imu =
      active.rig_from_sensor.inverse() * prepared.imus.front().rig_from_imu;
  setup.imu_samples = [sample = imu_sampler(flags, prepared)](std::int64_t from_ns,
                                                              std::int64_t until_ns) {
    return sample(0, from_ns, until_ns);
  };
  return setup;
}

class CaptureSink final : public FrameSink {
 public:
  CaptureSink(const std::string& path, std::size_t sensor_index, const Sensor& sensor,
              const PacketSetup& setup)
      : sensor_index_(sensor_index), writer_(path, sensor, setup.options, setup.imu_samples) {}

  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor_index) const override {
    return sensor_index == sensor_index_ ? hit_columns_for(kPacketColumns) : HitColumnMask{};
  }
  void write(const MeasuredFrame& measured) override {
    if (measured.sensor_index == sensor_index_) writer_.write(measured.frame, *measured.beams);
  }
  void finish() override { writer_.finish(); }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override {
    return writer_.files();
  }

 private:
  std::size_t sensor_index_;
  PacketWriter writer_;
};

class UdpSink final : public FrameSink {
 public:
  UdpSink(const link::PacketRoute& route, double speed, link::ErrorLog& errors,
          std::size_t sensor_index, const Sensor& sensor, const PacketSetup& setup)
      : sensor_index_(sensor_index),
        sensor_(sensor),
        packets_(sensor, setup.options, setup.imu_samples),
        sender_(route, speed, errors) {}

  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor_index) const override {
    return sensor_index == sensor_index_ ? hit_columns_for(kPacketColumns) : HitColumnMask{};
  }
  void write(const MeasuredFrame& measured) override {
    if (measured.sensor_index != sensor_index_) return;
    std::vector<UdpPacket> made;
    packets_.encode(measured.frame, *measured.beams, made);
    sender_.send(std::move(made), measured.frame.stamp_ns);
    const FrameInterval interval = frame_interval(sensor_, measured.frame.number);
    end_ns_ = measured.frame.stamp_ns + (interval.end_ns - interval.start_ns);
  }
  void finish() override {
    constexpr std::chrono::milliseconds kMaxDelay{200};  // SIGTERM ends the program soon
    std::vector<UdpPacket> made;
    packets_.finish(made);
    if (!made.empty()) sender_.send(std::move(made), end_ns_);
    sender_.finish(kMaxDelay);
  }

 private:
  std::size_t sensor_index_;
  Sensor sensor_;
  SensorPackets packets_;
  link::PacketSender sender_;
  std::int64_t end_ns_ = 0;  ///< of the last frame
};

/// Two kinds of packets: data, and the position of Velodyne or the IMU of Ouster.
link::PacketRoute route_of(const PacketTarget& target, const Sensor& sensor) {
  const bool is_from_ouster = is_ouster(sensor);
  const std::uint16_t data = is_from_ouster ? kOusterLidarPort : kVelodynePort;
  const std::uint16_t second = is_from_ouster ? kOusterImuPort : kVelodynePositionPort;
  static_assert(kHesaiPort == kVelodynePort);
  return {.host = target.host,
          .ports = {{data, target.data_port.value_or(data)},
                    {second, target.second_port.value_or(second)}}};
}

}  // namespace

std::unique_ptr<FrameSink> make_capture_sink(const std::string& path, const RenderFlags& flags,
                                             const PreparedScene& prepared, PoseOrigin origin) {
  const std::size_t index = packet_sensor(prepared, "", path);
  const ActiveSensor& active = prepared.sensors[index];
  return std::make_unique<CaptureSink>(path, index, active.sensor,
                                       setup_of(flags, prepared, origin, active));
}

std::unique_ptr<FrameSink> make_udp_sink(const PacketTarget& target, double speed,
                                         const RenderFlags& flags, const PreparedScene& prepared,
                                         PoseOrigin origin, link::ErrorLog& errors) {
  const std::size_t index = packet_sensor(prepared, target.sensor_name, "--udp");
  const ActiveSensor& active = prepared.sensors[index];
  return std::make_unique<UdpSink>(route_of(target, active.sensor), speed, errors, index,
                                   active.sensor, setup_of(flags, prepared, origin, active));
}

}  // namespace glidar::app
