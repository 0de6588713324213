// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/sidecar_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/unit_conversion.hpp>
#include <glidar/core/version.hpp>
#include <glidar/io/config/camera_info.hpp>
#include <glidar/io/config/field_json.hpp>
#include <glidar/io/config/json_numbers.hpp>
#include <glidar/io/config/json_text.hpp>
#include <glidar/io/config/sensor_keys.hpp>
#include <glidar/io/files/content_hash.hpp>
#include <glidar/io/formats/box_json.hpp>
#include <glidar/io/formats/sidecar.hpp>
#include <glidar/io/formats/stored_columns.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

namespace glidar {
namespace {

// Keys keep their order. Numbers that JSON cannot represent (NaN, infinity) become null.
using Json = nlohmann::ordered_json;

Json pose_json(const Pose& pose) {
  Json matrix = Json::array();
  for (Eigen::Index row = 0; row < 4; ++row) {
    const Eigen::RowVector4d r = pose.matrix().row(row);
    matrix.push_back({r[0], r[1], r[2], r[3]});
  }
  const PoseVector numbers = to_xyz_wxyz(pose);
  return {{"matrix", matrix},
          {"position_m", vector_json(pose.translation())},
          {"orientation",
           {{"w", numbers[3]}, {"x", numbers[4]}, {"y", numbers[5]}, {"z", numbers[6]}}}};
}

/// Values of a sensor that a sidecar lists after one of its keys.
Json beside_key(const std::string& key, const Sensor& sensor, const Beams& beams) {
  if (key == "name") {
    return {{"frame_id", beams.frame_id},
            {"rows", beams.rows},
            {"cols", beams.cols},
            {"boresight", vector_json(beams.boresight)}};
  }
  if (key == "optics") return {{"camera_info", camera_info_json(sensor.optics)}};
  // the quotient has few digits, unlike the product that reading a sensor file computes
  if (key == "wavelength_nm") {
    return {{"range_offset_m", in_unit(beams.range_offset_m, kMillimetre_m) / 1000.0}};
  }
  return Json::object();
}

/// All numbers of a sensor.
Json sensor_json(const Sensor& sensor, const Beams& beams) {
  Json json;
  const Json keys = write_struct(FieldVisitor::Mode::report, sensor_keys(sensor));
  for (const auto& [key, value] : keys.items()) {
    json[key] = value;
    json.update(beside_key(key, sensor, beams));
  }
  return json;
}

Json sensor_json(const SidecarContext& context) {
  Json json = sensor_json(context.sensor, context.beams);
  if (!context.sensor.variant.empty()) json["variant"] = context.sensor.variant;
  if (!context.sensor.mode.empty()) json["mode"] = context.sensor.mode;
  return json;
}

/// As stored in the file, which may be shorter, renamed or fewer than the cloud's.
Json columns_json(std::span<const PointField> fields) {
  Json columns = Json::array();
  for (const StoredColumn& stored : stored_columns(fields)) {
    columns.push_back({{"name", stored.column->name},
                       {"type", type_of(stored.stored).name},
                       {"components", stored.fields}});
  }
  return columns;
}

/// Null for clouds.
Json image_json(const CloudFile& job) {
  if (job.pixels.empty()) return {};
  Json image = {{"pixels", job.pixels}};
  if (job.pixels.find("units_per_m") != std::string::npos)
    image["units_per_m"] = job.options.depth_png_units_per_m;
  return image;
}

/// A factor, or one for each of the model's axes.
Json scale_json(const Instance& instance, const MeshSource& source) {
  if (source.stretch == Eigen::Vector3d::Ones()) return instance.scale;
  return vector_json(instance.scale * source.stretch);
}

/// Position and orientation.
Json short_pose_json(const Pose& pose) {
  Json json = pose_json(pose);
  json.erase("matrix");
  return json;
}

Json instances_json(const SidecarContext& context, const Frame& frame) {
  const Scene& scene = context.scene;
  Json instances = Json::array();
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const MeshSource& source = scene.sources.at(instance.mesh);
    instances.push_back({{"name", instance.name},
                         {"id", instance.id},
                         {"class_id", instance.class_id},
                         {"class", scene.class_names.at(instance.class_id)},
                         {"model", source.path},
                         {"model_hash", source.hash.empty() ? Json() : Json(source.hash)},
                         {"metres_per_unit", source.metres_per_unit},
                         {"up", source.up.empty() ? Json() : Json(source.up)},
                         {"scale", scale_json(instance, source)},
                         {"world_from_object", short_pose_json(frame.world_from_instance.at(i))}});
  }
  return instances;
}

/// Those that have moved since the first frame of the run.
Json moved_json(const SidecarContext& context, const Frame& frame, std::span<const Pose> first) {
  Json moved = Json::array();
  for (std::size_t i = 0; i < context.scene.instances.size(); ++i) {
    const Pose& pose = frame.world_from_instance.at(i);
    if (i < first.size() && first[i].matrix() == pose.matrix()) continue;
    moved.push_back(
        {{"id", context.scene.instances[i].id}, {"world_from_object", short_pose_json(pose)}});
  }
  return moved;
}

/// In the coordinate frame of a cloud; those with at least so many points.
Json boxes_json(const SidecarContext& context, const Frame& frame, const Pose& world_from_cloud,
                std::uint32_t min_points = 0) {
  const bool is_own = world_from_cloud.matrix() == frame.world_from_sensor.matrix();
  const Pose cloud_from_sensor =
      is_own ? Pose::Identity() : world_from_cloud.inverse() * frame.world_from_sensor;
  Json boxes = Json::array();
  for (const ObjectBox& box : frame.boxes) {
    if (box.points >= min_points) boxes.push_back(box_json(context.scene, box, cloud_from_sensor));
  }
  return boxes;
}

Json status_json(const Frame& frame) {
  // Neighbours mostly have the same status: separate counters avoid dependencies between
  // consecutive increments.
  constexpr std::size_t kLanes = 4;
  std::array<std::array<std::size_t, 256>, kLanes> counts{};
  for (std::size_t i = 0; i < frame.status.size(); ++i)
    ++counts[i % kLanes][static_cast<std::size_t>(frame.status[i])];
  Json by_name = Json::object();
  for (std::size_t s = 0; s < kStatusCount; ++s) {
    by_name[std::string(name(static_cast<Status>(s)))] =
        counts[0][s] + counts[1][s] + counts[2][s] + counts[3][s];
  }
  return by_name;
}

Json command_json(const CommandRecord& command, const std::filesystem::path& path) {
  if (command.arguments.empty()) return {};
  return {{"arguments", command.arguments}, {"folder", relative_folder(path, command.folder)}};
}

// names and paths may contain bytes that are not UTF-8
std::string on_one_line(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// A line for each key, for each key of an object in it, and for each part of a list of objects.
std::string text_of(Json json) {
  remove_negative_zeros(json);
  std::string text;
  const char* before = "{\n  ";
  for (const auto& [key, value] : json.items()) {
    text += before + on_one_line(key) + ": ";
    before = ",\n  ";
    const bool has_lines =
        value.is_object() || (value.is_array() && !value.empty() && value.front().is_object());
    if (!has_lines || value.empty()) {
      text += on_one_line(value);
      continue;
    }
    const char* line = value.is_object() ? "{\n    " : "[\n    ";
    for (const auto& [name, part] : value.items()) {
      text += line + (value.is_object() ? on_one_line(name) + ": " : "") + on_one_line(part);
      line = ",\n    ";
    }
    text += value.is_object() ? "\n  }" : "\n  ]";
  }
  return text + "\n}\n";
}

constexpr std::size_t kSeparatorBytes = 6;  // between the lines of a list

/// At least the number of values that a parser finds in a JSON text, where names of keys and ends
/// of objects and lists count too.
std::size_t max_values(std::string_view text) {
  std::size_t count = 1;
  for (const char c : text) {
    const bool opens = c == '{' || c == '[';
    count += opens ? 2U : c == '}' || c == ']' || c == ':' || c == ',' ? 1U : 0U;
  }
  return count;
}

/// The files that a sidecar lists which is about to be replaced by `own`, if they have the same
/// measurement.
Json other_files(const std::filesystem::path& path, const Json& own) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return Json::array();
  try {
    return Json::parse(listed_files(path, on_one_line(own)));
  } catch (const Error&) {  // it is damaged, or not a sidecar
  }
  return Json::array();
}

/// What all frames of a run have in common.
Json run_json(const SidecarContext& context, const Frame& frame,
              const std::filesystem::path& path) {
  return {{"glidar", version()},
          {"command", command_json(context.command, path)},
          {"renderer", context.renderer},
          {"sensor", sensor_json(context)},
          {"instances", instances_json(context, frame)}};
}

/// What is particular to a frame.
Json frame_json(const SidecarContext& context, const Frame& frame,
                std::span<const SidecarEntry> files) {
  Json listed = Json::array();
  for (const SidecarEntry& file : files) listed.push_back(Json::parse(file.json));
  return {{"seed", frame.seed},
          {"frame", frame.number},
          {"frame_hash", frame_hash(frame)},
          {"stamp_ns", frame.stamp_ns},
          {"world_from_sensor", pose_json(frame.world_from_sensor)},
          {"files", std::move(listed)},
          {"boxes", boxes_json(context, frame, files.front().world_from_cloud)},
          {"beams_by_status", status_json(frame)}};
}

}  // namespace

std::string sensor_to_json(const Sensor& sensor, const Beams& beams) {
  constexpr int kIndent = 2;
  Json json = sensor_json(sensor, beams);
  remove_negative_zeros(json);
  return json.dump(kIndent, ' ', false, Json::error_handler_t::replace);
}

SidecarEntry sidecar_entry(const CloudFile& job, const std::filesystem::path& path) {
  const PointCloud& cloud = job.cloud;
  Json json = {{"file", path.filename().string()},
               {"rows", cloud.rows},
               {"cols", cloud.cols},
               {"frame_id", cloud.frame_id},
               {"world_from_cloud", job.has_moved ? Json() : pose_json(cloud.world_from_cloud)},
               {"layout", job.layout.empty() ? Json() : Json(job.layout)},
               {"columns", columns_json(job.fields)},
               {"image", image_json(job)}};
  remove_negative_zeros(json);
  return {on_one_line(json), cloud.world_from_cloud};
}

std::string sidecar_text(const SidecarContext& context, const Frame& frame,
                         std::span<const SidecarEntry> files, const std::filesystem::path& path) {
  Json all = run_json(context, frame, path);
  all.update(frame_json(context, frame, files));
  for (const Json& other : other_files(path, all)) {
    const auto is_same = [&](const Json& file) { return file["file"] == other.value("file", ""); };
    if (std::ranges::none_of(all["files"], is_same)) all["files"].push_back(other);
  }
  return text_of(std::move(all));
}

RunSidecar run_sidecar(const SidecarContext& context, const Frame& first,
                       const std::filesystem::path& path) {
  Json json = run_json(context, first, path);
  remove_negative_zeros(json);
  const std::string text = on_one_line(json);
  json.erase("command");  // runs by Python have none
  const std::string measured = on_one_line(json);
  ContentHash hash;
  hash.add(measured.data(), measured.size());
  RunSidecar run;
  run.path = path;
  run.json = text;
  run.hash = hex(hash.value());
  run.world_from_instance = first.world_from_instance;
  return run;
}

void RunSidecar::add_frame(std::string entry) {
  constexpr std::size_t kRoomForFiles = std::size_t{1} << 20U;  // bytes and values
  const std::size_t bytes = bytes_ + entry.size() + kSeparatorBytes;
  const std::size_t values = values_ + max_values(entry);
  const bool fits = bytes + json.size() + kRoomForFiles <= kMaxSidecarBytes &&
                    values + max_values(json) + kRoomForFiles <= JsonLimits().max_values;
  if (!fits || unlisted_frames > 0) {
    ++unlisted_frames;
    return;
  }
  bytes_ = bytes;
  values_ = values;
  frames.push_back(std::move(entry));
}

std::string sidecar_text(const RunSidecar& run, std::span<const SidecarEntry> files) {
  Json all = Json::parse(run.json);
  all["run_hash"] = run.hash;
  for (const SidecarEntry& file : files) all["files"].push_back(Json::parse(file.json));
  if (run.unlisted_frames > 0) all["unlisted_frames"] = run.unlisted_frames;
  std::string text = text_of(std::move(all));
  if (run.frames.empty()) return text;
  text.resize(text.size() - std::string_view("\n}\n").size());
  const char* line = ",\n  \"frames\": [\n    ";
  for (const std::string& frame : run.frames) {
    text += line + frame;
    line = ",\n    ";
  }
  return text + "\n  ]\n}\n";
}

std::string frame_entry(const SidecarContext& context, const Frame& frame, const RunSidecar& run,
                        std::span<const FramePoints> points, const Pose& world_from_cloud) {
  Json counts = Json::object();
  for (const FramePoints& one : points) counts[one.file] = one.points;
  Json json = {{"frame", frame.number},
               {"seed", frame.seed},
               {"frame_hash", frame_hash(frame)},
               {"stamp_ns", frame.stamp_ns},
               {"world_from_sensor", short_pose_json(frame.world_from_sensor)},
               {"points", std::move(counts)},
               {"moved", moved_json(context, frame, run.world_from_instance)},
               {"boxes", boxes_json(context, frame, world_from_cloud, 1)},
               {"beams_by_status", status_json(frame)}};
  remove_negative_zeros(json);
  return on_one_line(json);
}

std::string sidecar_text(const SidecarContext& context, const Frame& frame,
                         std::span<const SidecarEntry> files, const RunSidecar& run) {
  Json all = {{"glidar", version()},
              {"run", run.path.filename().string()},
              {"run_hash", run.hash},
              {"moved", moved_json(context, frame, run.world_from_instance)}};
  all.update(frame_json(context, frame, files));
  return text_of(std::move(all));
}

}  // namespace glidar
