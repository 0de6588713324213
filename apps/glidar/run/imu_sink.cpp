// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/imu_sink.hpp>

#include <apps/glidar/run/imu_outputs.hpp>
#include <glidar/core/error.hpp>

#include <algorithm>
#include <cstdint>
#include <optional>

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

}  // namespace

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

}  // namespace glidar::app
