// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/recording_sinks.hpp>

#include <apps/glidar/options/option_values.hpp>
#include <apps/glidar/run/frame_sink.hpp>
#include <apps/glidar/run/packet_sinks.hpp>
#include <apps/glidar/run/prepared_scene.hpp>
#include <apps/glidar/run/rig_messages.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/bags/bag.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/formats/file_sink.hpp>
#include <glidar/io/formats/kitti_writer.hpp>
#include <glidar/io/osi/osi_trace.hpp>
#include <glidar/io/packets/packet_writer.hpp>

#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

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

/// An OSI trace with the detections of every sensor and the ground truth of all objects, see
/// docs/osi.md.
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

std::vector<KittiSensor> kitti_sensors(const PreparedScene& prepared) {
  std::vector<KittiSensor> sensors;
  for (const ActiveSensor& active : prepared.sensors)
    sensors.push_back({active.sensor, active.rig_from_sensor});
  return sensors;
}

/// A KITTI folder with the scans and images of all frames, see docs/files/kitti.md. `read`: files
/// that it must not replace.
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

/// A bag with the topics of docs/bags.md: the clouds and images of every sensor, the samples of
/// every IMU, the transforms of the rig and its ground truth.
class BagSink final : public FrameSink {
 public:
  BagSink(const std::string& path, const RenderFlags& flags, const PreparedScene& prepared,
          PoseOrigin origin)
      : path_(path),
        bag_(bags::create_bag(path)),
        publisher_(make_rig_publisher(*bag_, flags, prepared, origin)) {}

  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor_index) const override {
    return publisher_->hit_columns(sensor_index);
  }
  void write(const MeasuredFrame& measured) override {
    publisher_->publish(measured.sensor_index, measured.frame, *measured.beams);
  }
  void finish() override {
    publisher_->finish();
    bag_->finish();
  }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override { return {path_}; }

 private:
  std::string path_;
  std::unique_ptr<bags::BagWriter> bag_;
  std::unique_ptr<ros::RigPublisher> publisher_;
};

/// Throws Error when two recordings have the same name.
void check_names(const std::vector<std::string>& paths) {
  std::set<std::filesystem::path> names;
  for (const std::string& path : paths) {
    if (names.insert(real_path(path)).second) continue;
    throw Error({path, "is given twice as output", "", "choose another name"});
  }
}

/// Flags and scene must outlive it. Throws Error.
std::unique_ptr<FrameSink> make_recording_sink(const std::string& path, const RenderFlags& flags,
                                               const PreparedScene& prepared,
                                               const std::vector<std::string>& read,
                                               PoseOrigin origin) {
  if (is_kitti_name(path)) return std::make_unique<KittiSink>(path, flags, prepared, read);
  if (is_capture_name(path)) return make_capture_sink(path, flags, prepared, origin);
  if (osi::is_osi_trace_name(path))
    return std::make_unique<OsiSink>(path, osi_rig(prepared, origin));
  return std::make_unique<BagSink>(path, flags, prepared, origin);
}

}  // namespace

std::vector<std::unique_ptr<FrameSink>> make_recording_sinks(const RenderFlags& flags,
                                                             const PreparedScene& prepared,
                                                             const std::vector<std::string>& read,
                                                             PoseOrigin origin) {
  std::vector<std::unique_ptr<FrameSink>> sinks;
  with_option_name("--output", [&] {
    check_names(flags.output.recording_paths);
    for (const std::string& path : flags.output.recording_paths) {
      refuse_overwrite_of_inputs(read, path);
      sinks.push_back(make_recording_sink(path, flags, prepared, read, origin));
    }
  });
  return sinks;
}

}  // namespace glidar::app
