// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/kitti_writer.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/point_cloud.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/core/text.hpp>
#include <glidar/core/time_text.hpp>
#include <glidar/io/files/cache_folder.hpp>
#include <glidar/io/formats/kitti_file.hpp>
#include <glidar/io/formats/kitti_folder.hpp>
#include <glidar/io/formats/truth_images.hpp>
#include <glidar/io/pictures/picture.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

namespace glidar {
namespace {

/// A name as a quoted text; JSON's are YAML's.
std::string yaml_text(const std::string& name) {
  return nlohmann::json(name).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// A map from each class number; `value(number)` gives the text.
template <class Value>
std::string class_map(const char* key, const Scene& scene, const Value& value) {
  std::string text = fmt::format("{}:\n", key);
  for (std::uint32_t i = 0; i < scene.class_names.size(); ++i)
    text += fmt::format("  {}: {}\n", i, value(i));
  return text;
}

/// Blue, green and red, as the API stores them.
std::string colour_text(std::uint32_t class_id) {
  if (class_id == 0) return "[0, 0, 0]";
  const Colour colour = category_colour(class_id);
  return fmt::format("[{}, {}, {}]", colour.b, colour.g, colour.r);
}

/// The classes of a scene as a configuration of the SemanticKITTI API: the text of a YAML file with
/// names and colours of labels, which are learned as they are, except 0 (unlabelled).
std::string kitti_classes(const Scene& scene) {
  const auto number = [](std::uint32_t i) { return std::to_string(i); };
  const auto is_ignored = [](std::uint32_t i) { return i == 0 ? "True" : "False"; };
  return "name: \"glidar\"\n" +
         class_map("labels", scene,
                   [&](std::uint32_t i) { return yaml_text(scene.class_names[i]); }) +
         class_map("color_map", scene, colour_text) + class_map("learning_map", scene, number) +
         class_map("learning_map_inv", scene, number) +
         class_map("learning_ignore", scene, is_ignored) +
         "split:\n  train: [0]\n  valid: [0]\n  test: [0]\n";
}

constexpr std::size_t kMaxCameras = 2;  // image_2 and image_3

bool has_pinhole(const KittiSensor& sensor) {
  return std::holds_alternative<Pinhole>(sensor.sensor.optics);
}

/// The sensor that makes the scans.
std::size_t scanner_of(const std::vector<KittiSensor>& sensors) {
  const auto found = std::find_if_not(sensors.begin(), sensors.end(), has_pinhole);
  return found == sensors.end() ? 0 : static_cast<std::size_t>(found - sensors.begin());
}

}  // namespace

struct KittiWriter::State {
  /// A camera of the folder.
  struct ImageCamera {
    std::size_t sensor = 0;
    std::string folder;                       ///< image_2
    std::vector<std::byte> png = {};          ///< of its last frame; empty: none yet
    std::vector<std::uint32_t> waiting = {};  ///< scans that have no image yet
  };

  std::filesystem::path folder;
  const Scene& scene;
  std::vector<KittiSensor> sensors;
  KittiWriterOptions options;
  std::size_t scanner = 0;
  std::vector<KittiCamera> cameras = {};  ///< of calibrations
  std::vector<ImageCamera> images = {};
  std::uint32_t scans = 0;
  std::int64_t scan_ns = 0;                   ///< stamp of the last scan
  std::optional<Pose> first_from_world = {};  ///< of the first scan's camera
  std::string times = {};
  std::string poses = {};
  PointCloud cloud = {};
  PointCloud hits = {};
  std::optional<FolderLock> lock = {};  ///< excludes other runs from the folder
  StagedFiles root = {};                ///< removes the folder again if nothing is written

  void find_cameras();
  void prepare(StagedFiles& files) const;
  void write_scan(const Frame& frame, const Beams& beams);
  void add_pose(const Frame& frame);
  void take_image(ImageCamera& camera, const Frame& frame, const Beams& beams);
  void write_images(ImageCamera& camera);
};

void KittiWriter::State::find_cameras() {
  const Pose velodyne_from_rig = sensors[scanner].rig_from_sensor.inverse();
  for (std::size_t i = 0; i < sensors.size() && images.size() < kMaxCameras; ++i) {
    const Pose camera_from_velodyne =
        i == scanner ? Pose::Identity()
                     : Pose((velodyne_from_rig * sensors[i].rig_from_sensor).inverse());
    const auto camera = kitti_camera(sensors[i].sensor, camera_from_velodyne);
    if (!camera) continue;
    cameras.push_back(*camera);
    images.push_back({.sensor = i, .folder = fmt::format("image_{}", 2 + images.size())});
  }
  if (cameras.empty()) cameras.push_back(kitti_camera(sensors[scanner].sensor));
}

void KittiWriter::State::prepare(StagedFiles& files) const {
  files.protect(options.inputs);
  files.set_locked();
}

void KittiWriter::State::write_scan(const Frame& frame, const Beams& beams) {
  static const std::vector<std::string> kColumns = {"xyz", "intensity", "range", "instance",
                                                    "class"};
  OutputFrame axes = output_frame("sensor", beams, frame.world_from_sensor);
  axes.deskew = options.deskew;
  make_point_cloud(frame, beams, scene, axes, kColumns, cloud);
  remove_invalid_points(cloud, hits);
  const Sensor& sensor = sensors[scanner].sensor;
  const PointCloud velodyne = kitti_cloud(hits, sensor, beams);
  const std::vector<PointField> fields = kitti_fields(velodyne);
  const FileSinkOptions sink;
  const SidecarContext context{.scene = scene,
                               .sensor = sensor,
                               .beams = beams,
                               .renderer = options.renderer,
                               .inputs = options.inputs};
  StagedFiles files;
  prepare(files);
  const CloudFile job{velodyne, frame, sink, context, fields};
  stage_kitti_scan({job, scans, cameras}, folder, files);
  files.commit();
  add_pose(frame);
}

/// Poses are of the first camera relative to its first one, as in the odometry benchmark.
void KittiWriter::State::add_pose(const Frame& frame) {
  const Pose world_from_camera =
      frame.world_from_sensor * cameras.front().camera_from_velodyne.inverse();
  if (!first_from_world) first_from_world = world_from_camera.inverse();
  scan_ns = frame.stamp_ns;
  times += decimal_seconds(scan_ns) + '\n';
  poses +=
      kitti_pose_line(scans == 0 ? Pose::Identity() : Pose(*first_from_world * world_from_camera));
  for (ImageCamera& camera : images) camera.waiting.push_back(scans);
  ++scans;
}

/// A scan gets the last image that does not start later, or the first one.
void KittiWriter::State::take_image(ImageCamera& camera, const Frame& frame, const Beams& beams) {
  static const std::vector<std::string> kColumns = {"colour", "incidence"};
  if (frame.stamp_ns > scan_ns && !camera.png.empty()) write_images(camera);
  make_point_cloud(frame, beams, scene, output_frame("sensor", beams, frame.world_from_sensor),
                   kColumns, cloud);
  const std::vector<std::uint8_t> pixels = rgb_pixels(cloud);
  camera.png =
      encode_png({PngKind::rgb8, cloud.cols, cloud.rows, std::as_bytes(std::span(pixels)), {}});
}

void KittiWriter::State::write_images(ImageCamera& camera) {
  if (camera.waiting.empty() || camera.png.empty()) return;
  StagedFiles files;
  prepare(files);
  files.add_folder(folder / camera.folder);
  for (const std::uint32_t scan : camera.waiting) {
    AtomicFile& file = files.add(folder / camera.folder / (kitti_number(scan) + ".png"));
    file.write(camera.png);
    file.finish();
  }
  files.commit();
  camera.waiting.clear();
}

KittiWriter::KittiWriter(std::filesystem::path folder, const Scene& scene,
                         std::vector<KittiSensor> sensors, KittiWriterOptions options)
    : state_(new State{.folder = std::move(folder),
                       .scene = scene,
                       .sensors = std::move(sensors),
                       .options = std::move(options)}) {
  state_->scanner = scanner_of(state_->sensors);
  state_->find_cameras();
  state_->root.add_folder(state_->folder);
  state_->lock = FolderLock::of_run(state_->folder);
}

KittiWriter::~KittiWriter() = default;

HitColumnMask KittiWriter::hit_columns(std::size_t sensor) const {
  HitColumnMask hit_columns;
  hit_columns.boxes = sensor == state_->scanner;
  for (const State::ImageCamera& camera : state_->images) {
    hit_columns.colour = hit_columns.colour || camera.sensor == sensor;
    hit_columns.incidence = hit_columns.incidence || camera.sensor == sensor;
  }
  return hit_columns;
}

void KittiWriter::write(std::size_t sensor, const Frame& frame, const Beams& beams) {
  for (State::ImageCamera& camera : state_->images) {
    if (camera.sensor == sensor) state_->take_image(camera, frame, beams);
  }
  if (sensor == state_->scanner) state_->write_scan(frame, beams);
}

void KittiWriter::finish() {
  State& state = *state_;
  for (State::ImageCamera& camera : state.images) state.write_images(camera);
  StagedFiles files;
  state.prepare(files);
  stage_text(state.folder / "times.txt", state.times, files);
  stage_text(state.folder / "poses.txt", state.poses, files);
  stage_text(state.folder / "calib.txt",
             kitti_calibration(state.cameras, KittiCalibration::sequence), files);
  if (has_classes(state.scene)) {
    stage_text(state.folder / "semantic-kitti.yaml", kitti_classes(state.scene), files);
  }
  files.commit();
  const std::string next = kitti_number(state.scans);
  std::error_code ignored;  // a folder that cannot be read has no such file for us
  if (!std::filesystem::exists(state.folder / "velodyne" / (next + ".bin"), ignored)) return;
  throw Error({state.folder.string(),
               fmt::format("has scans of an earlier run, from velodyne/{}.bin on", next),
               fmt::format("the {} scans of this run alone, which are written", state.scans),
               "remove the others, or write to a new folder"});
}

bool is_kitti_name(const std::filesystem::path& path) {
  const std::filesystem::path name = path.has_filename() ? path : path.parent_path();
  return lower_case(name.extension().string()) == ".kitti";
}

}  // namespace glidar
