// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/kitti_sink.hpp>

#include <glidar/io/formats/file_sink.hpp>
#include <glidar/io/formats/kitti_writer.hpp>

namespace glidar::app {
namespace {

std::vector<KittiSensor> kitti_sensors(const PreparedScene& prepared) {
  std::vector<KittiSensor> sensors;
  for (const ActiveSensor& active : prepared.sensors)
    sensors.push_back({active.sensor, active.rig_from_sensor});
  return sensors;
}

class KittiSink final : public FrameSink {
 public:
  KittiSink(const std::string& path, const RenderFlags& flags, const PreparedScene& prepared,
            const std::vector<std::string>& read)
      : path_(output_path(path)),
        writer_(path_, prepared.scene, kitti_sensors(prepared),
                {.deskew = flags.output.deskew, .renderer = renderer_name(flags), .inputs = read}) {
  }

  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor_index) const override {
    return writer_.hit_columns(sensor_index);
  }
  void write(const MeasuredFrame& measured) override {
    writer_.write(measured.sensor_index, measured.frame, *measured.beams);
  }
  void finish() override { writer_.finish(); }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override { return {path_}; }

 private:
  std::filesystem::path path_;
  KittiWriter writer_;
};

}  // namespace

std::unique_ptr<FrameSink> make_kitti_sink(const std::string& path, const RenderFlags& flags,
                                           const PreparedScene& prepared,
                                           const std::vector<std::string>& read) {
  return std::make_unique<KittiSink>(path, flags, prepared, read);
}

}  // namespace glidar::app
