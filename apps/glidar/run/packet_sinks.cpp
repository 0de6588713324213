// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/packet_sinks.hpp>

#include <apps/glidar/run/packet_setup.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/packets/packet_writer.hpp>
#include <glidar/io/packets/sensor_packets.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace glidar::app {
namespace {

class CaptureSink final : public FrameSink {
 public:
  CaptureSink(const std::string& path, std::size_t sensor_index, const Sensor& sensor,
              const ros::PublishedPackets& setup)
      : sensor_index_(sensor_index), writer_(path, sensor, setup.options, setup.imu_samples) {}

  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor_index) const override {
    return sensor_index == sensor_index_ ? hit_columns_for(packet_columns()) : HitColumnMask{};
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

}  // namespace

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
               "a sensor of the rig that is a preset of Velodyne, Ouster, Hesai or Livox"});
}

std::unique_ptr<FrameSink> make_capture_sink(const std::string& path, const RenderFlags& flags,
                                             const PreparedScene& prepared, PoseOrigin origin) {
  const std::size_t index = packet_sensor(prepared, "", path);
  const ActiveSensor& active = prepared.sensors[index];
  return std::make_unique<CaptureSink>(path, index, active.sensor,
                                       packet_setup(flags, prepared, origin, active));
}

}  // namespace glidar::app
