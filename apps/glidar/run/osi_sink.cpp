// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/osi_sink.hpp>

#include <glidar/io/osi/osi_trace.hpp>

#include <utility>

namespace glidar::app {
namespace {

osi::OsiRig osi_rig(const PreparedScene& prepared, PoseOrigin origin) {
  osi::OsiRig rig{.scene = prepared.scene, .sensors = {}};
  for (const ActiveSensor& active : prepared.sensors)
    rig.sensors.push_back({active.id, active.sensor, active.rig_from_sensor});
  if (origin == PoseOrigin::motion)
    rig.motion = {prepared.motion.world_from_rig, prepared.motion.world_from_instance};
  return rig;
}

class OsiSink final : public FrameSink {
 public:
  OsiSink(const std::string& path, osi::OsiRig rig) : path_(path), trace_(path, std::move(rig)) {}

  [[nodiscard]] HitColumnMask hit_columns(std::size_t /*sensor_index*/) const override {
    return hit_columns_for(osi::OsiTraceWriter::columns());
  }
  void write(const MeasuredFrame& measured) override {
    trace_.write(measured.sensor_index, measured.frame, *measured.beams);
  }
  void finish() override { trace_.finish(); }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override { return {path_}; }

 private:
  std::string path_;
  osi::OsiTraceWriter trace_;
};

}  // namespace

std::unique_ptr<FrameSink> make_osi_sink(const std::string& path, const PreparedScene& prepared,
                                         PoseOrigin origin) {
  return std::make_unique<OsiSink>(path, osi_rig(prepared, origin));
}

}  // namespace glidar::app
