// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/output/output.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/bags/bag.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/formats/imu_samples_file.hpp>
#include <glidar/io/formats/kitti_writer.hpp>
#include <glidar/io/osi/osi_trace.hpp>
#include <glidar/io/packets/ouster.hpp>
#include <glidar/io/packets/sensor_packets.hpp>
#include <glidar/io/ros/published_rig.hpp>
#include <glidar/output/frame_files.hpp>
#include <glidar/output/network.hpp>
#include <glidar/output/rig_messages.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace glidar {
namespace {

/// The ends of the names of IMU samples have equal lengths.
constexpr std::size_t kImuSuffix = std::string_view(".imu.csv").size();

/// The samples of all IMUs, from the start of the run to its end, both included: NAME_imu.imu.csv
/// for NAME.imu.csv if there are several.
class ImuFiles final : public Output {
 public:
  ImuFiles(std::vector<std::string> paths, OutputRig rig, Report report)
      : paths_(std::move(paths)), rig_(std::move(rig)), report_(std::move(report)) {}

  [[nodiscard]] HitColumnMask hit_columns(std::size_t /*sensor*/) const override { return {}; }
  void write(const RigFrame& written) override {
    const Frame& frame = written.frame;
    const FrameInterval interval =
        frame_interval(rig_.sensors[written.sensor].sensor, frame.number);
    const std::int64_t end_ns = frame.stamp_ns + (interval.end_ns - interval.start_ns);
    last_ns_ = std::max(last_ns_.value_or(end_ns), end_ns);
  }
  void finish() override {
    const std::optional<std::int64_t> end_ns = rig_.end_ns ? rig_.end_ns : last_ns_;
    if (!end_ns) return;
    warn_linear_interpolation(rig_.motion->world_from_rig, rig_.imus.front().name, report_);
    const ros::ImuSampler sample = imu_sampler(rig_);
    for (std::size_t i = 0; i < rig_.imus.size(); ++i) {
      const RigImu& imu = rig_.imus[i];
      const ImuSamples samples = sample(i, rig_.start_ns, *end_ns + 1);
      for (const std::string& path : paths_) {
        write_imu_samples(samples, {imu.name, imu.imu, imu_run(rig_, i), imu.rig_from_imu},
                          file_of(path, imu), rig_.inputs);
        text_ += fmt::format("{} samples of {}\nwrote {}\n", samples.t_ns.size(),
                             printable_line(imu.imu.name), printable_line(file_of(path, imu)));
        written_.emplace_back(file_of(path, imu));
      }
    }
  }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override { return written_; }
  [[nodiscard]] std::string written_text() const override { return text_; }

 private:
  [[nodiscard]] std::string file_of(const std::string& path, const RigImu& imu) const {
    if (rig_.imus.size() == 1) return path;
    return std::string(path).insert(path.size() - kImuSuffix, "_" + imu.name);
  }

  std::vector<std::string> paths_;
  OutputRig rig_;
  Report report_;
  std::optional<std::int64_t> last_ns_;  ///< end of the last frame
  std::vector<std::filesystem::path> written_;
  std::string text_;
};

/// The packets of a sensor in a pcap file, see docs/packets.md.
class Capture final : public Output {
 public:
  Capture(const std::string& path, const OutputRig& rig, const OutputOptions& options)
      : sensor_(packet_sensor(rig, "", path)),
        setup_(packet_setup(rig, options, rig.sensors[sensor_])),
        writer_(path, rig.sensors[sensor_].sensor, setup_.options, setup_.imu_samples) {}

  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor) const override {
    return sensor == sensor_ ? hit_columns_for(packet_columns(setup_.options)) : HitColumnMask{};
  }
  void write(const RigFrame& written) override {
    if (written.sensor == sensor_) writer_.write(written.frame, written.beams);
  }
  void finish() override { writer_.finish(); }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override {
    return writer_.files();
  }

 private:
  std::size_t sensor_;
  ros::PublishedPackets setup_;
  PacketWriter writer_;
};

osi::OsiRig osi_rig(const OutputRig& rig) {
  osi::OsiRig made{.scene = rig.scene, .sensors = {}};
  for (const OutputSensor& sensor : rig.sensors)
    made.sensors.push_back({sensor.id, sensor.sensor, sensor.rig_from_sensor});
  if (rig.motion) made.motion = {rig.motion->world_from_rig, rig.motion->world_from_instance};
  return made;
}

/// An OSI trace with the detections of every sensor and the ground truth of all objects, see
/// docs/osi.md.
class OsiTrace final : public Output {
 public:
  OsiTrace(const std::string& path, const OutputRig& rig)
      : path_(path), trace_(path, osi_rig(rig)) {}

  [[nodiscard]] HitColumnMask hit_columns(std::size_t /*sensor*/) const override {
    return hit_columns_for(osi::OsiTraceWriter::columns());
  }
  void write(const RigFrame& written) override {
    trace_.write(written.sensor, written.frame, written.beams);
  }
  void finish() override { trace_.finish(); }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override { return {path_}; }

 private:
  std::string path_;
  osi::OsiTraceWriter trace_;
};

std::vector<KittiSensor> kitti_sensors(const OutputRig& rig) {
  std::vector<KittiSensor> sensors;
  for (const OutputSensor& sensor : rig.sensors)
    sensors.push_back({sensor.sensor, sensor.rig_from_sensor});
  return sensors;
}

/// A KITTI folder with the scans and images of all frames, see docs/files/kitti.md.
class KittiFolder final : public Output {
 public:
  KittiFolder(const std::string& path, const OutputRig& rig, const OutputOptions& options)
      : path_(output_path(path)),
        writer_(path_, rig.scene, kitti_sensors(rig),
                {.deskew = options.deskew, .renderer = rig.renderer, .inputs = rig.inputs}) {}

  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor) const override {
    return writer_.hit_columns(sensor);
  }
  void write(const RigFrame& written) override {
    writer_.write(written.sensor, written.frame, written.beams);
  }
  void finish() override { writer_.finish(); }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override { return {path_}; }

 private:
  std::filesystem::path path_;
  KittiWriter writer_;
};

/// A bag with the topics of docs/bags.md: the clouds and images of every sensor, the samples of
/// every IMU, the transforms of the rig and its ground truth.
class Bag final : public Output {
 public:
  Bag(const std::string& path, const OutputRig& rig, const OutputOptions& options)
      : path_(path),
        bag_(bags::create_bag(path)),
        publisher_(make_rig_publisher(*bag_, rig, options)) {}

  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor) const override {
    return publisher_->hit_columns(sensor);
  }
  void write(const RigFrame& written) override {
    publisher_->publish(written.sensor, written.frame, written.beams);
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

std::vector<OutputFormat> make_formats() {
  std::vector<OutputFormat> formats;
  for (const FileFormat& file : file_formats()) {
    const OutputKind kind =
        is_kitti_name("a" + file.suffix) ? OutputKind::kitti_folder : OutputKind::frame_file;
    formats.push_back({file.suffix, kind, file.description, file.missing});
  }
  formats.insert(formats.end(),
                 {{".imu.csv", OutputKind::imu_samples, "samples of IMUs, text"},
                  {".imu.npz", OutputKind::imu_samples, "samples of IMUs, NumPy archive"},
                  {".mcap", OutputKind::bag, "ROS bag of all frames and sensors"},
                  {".rosbag2", OutputKind::bag, "the same as a folder with SQLite, for ros2 bag"},
                  {".pcap", OutputKind::capture, "UDP packets as the sensor sends them"},
                  {".osi", OutputKind::osi_trace, "OSI trace of all frames and sensors"}});
  return formats;
}

}  // namespace

std::string Output::written_text() const {
  std::string text;
  for (const std::filesystem::path& file : files()) text += " " + printable_line(file.string());
  return text.empty() ? text : "wrote" + text + "\n";
}

void set_driver(const std::string& name, OutputOptions& options) {
  if (!name.empty()) options.messages.drivers.push_back({"", &ros::find_driver(name)});
}

void set_ouster_profile(const std::string& name, OutputOptions& options) {
  if (name.empty()) return;
  const std::span<const std::string_view> names = ouster_profile_names();
  const auto found = std::ranges::find(names, name);
  if (found == names.end())
    throw Error({"ouster_profile", "'" + name + "'", fmt::format("{}", fmt::join(names, ", "))});
  options.ouster_profile = static_cast<OusterProfile>(found - names.begin());
}

void set_livox_type(int number, OutputOptions& options) {
  if (number == 0) return;
  if (number < 1 || number > 3)
    throw Error({"livox_data_type", std::to_string(number), "1, 2 or 3"});
  options.livox_type = static_cast<LivoxDataType>(number);
}

std::span<const OutputFormat> output_formats() {
  static const std::vector<OutputFormat> kFormats = make_formats();
  return kFormats;
}

OutputKind output_kind(const std::filesystem::path& path) {
  if (is_imu_samples_path(path)) return OutputKind::imu_samples;
  if (bags::is_bag_name(path)) return OutputKind::bag;
  if (is_capture_name(path)) return OutputKind::capture;
  if (osi::is_osi_trace_name(path)) return OutputKind::osi_trace;
  if (is_kitti_name(path)) return OutputKind::kitti_folder;
  if (has_format(path)) return OutputKind::frame_file;
  std::vector<std::string> others;
  for (const OutputFormat& format : output_formats().subspan(file_formats().size()))
    others.push_back(format.suffix);
  refuse_suffix(path, others);
}

std::string suffixes_of(OutputKind kind) {
  std::string text;
  for (const OutputFormat& format : output_formats()) {
    if (format.kind == kind) text += (text.empty() ? "" : " ") + format.suffix;
  }
  return text;
}

std::unique_ptr<Output> open_imu_samples(std::vector<std::string> paths, const OutputRig& rig,
                                         const Report& report) {
  if (rig.imus.empty()) {
    throw Error({paths.front(), "there is no IMU",
                 "a scene file with 'imus', or an IMU at the sensor",
                 "add --imu BMI088, for example, or imus= in Python"});
  }
  if (!rig.motion) {
    throw Error({paths.front(),
                 "samples of IMUs, but a simulator or a client gives the poses of frames",
                 "a motion that is known at all times", "leave it out"});
  }
  return std::make_unique<ImuFiles>(std::move(paths), rig, report);
}

void check_options_used(const std::string& path, const OutputOptions& options) {
  const bool is_file = !is_url(path) && output_kind(path) == OutputKind::frame_file;
  const bool has_messages =
      path.starts_with("ros2://") || (!is_url(path) && output_kind(path) == OutputKind::bag);
  if (!options.sink.layout.empty() && !has_messages && (!is_file || !takes_layout(path))) {
    throw Error({path, "the layout '" + options.sink.layout + "', which it cannot have",
                 "a bag, ROS 2, or the suffix " + suffixes_with_layouts(), "leave layout out"});
  }
  if (options.sink.crs.empty() || (is_file && format_for(path).is_survey)) return;
  throw Error({path, "a coordinate reference system, which it cannot have", "the suffix .las",
               "leave crs out"});
}

std::unique_ptr<Output> open_output(const std::string& path, const OutputRig& rig,
                                    const OutputOptions& options, const Report& report) {
  if (is_url(path)) return open_url(path, rig, options, report);
  const OutputKind kind = output_kind(path);
  if (kind == OutputKind::imu_samples) return open_imu_samples({path}, rig, report);
  if (kind == OutputKind::frame_file) {
    FrameFileRequest request{options};
    request.paths = {path};
    check_frame_files(numbered(request, 0));
    return std::make_unique<FrameFiles>(request, true, rig, report);
  }
  refuse_overwrite_of_inputs(rig.inputs, path);
  switch (kind) {
    case OutputKind::kitti_folder:
      return std::make_unique<KittiFolder>(path, rig, options);
    case OutputKind::capture:
      return std::make_unique<Capture>(path, rig, options);
    case OutputKind::osi_trace:
      return std::make_unique<OsiTrace>(path, rig);
    default:
      return std::make_unique<Bag>(path, rig, options);
  }
}

}  // namespace glidar
