// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/sidecar_file.hpp>

#include <glidar/core/unit_conversion.hpp>
#include <glidar/core/version.hpp>
#include <glidar/io/config/camera_info.hpp>
#include <glidar/io/config/field_json.hpp>
#include <glidar/io/config/json_numbers.hpp>
#include <glidar/io/config/sensor_keys.hpp>
#include <glidar/io/formats/box_json.hpp>
#include <glidar/io/formats/sidecar.hpp>
#include <glidar/io/formats/stored_columns.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>

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

Json sensor_json(const CloudFile& job) {
  Json json = sensor_json(job.context.sensor, job.context.beams);
  const Sensor& sensor = job.context.sensor;
  if (!sensor.variant.empty()) json["variant"] = sensor.variant;
  if (!sensor.mode.empty()) json["mode"] = sensor.mode;
  json["world_from_sensor"] = pose_json(job.frame.world_from_sensor);
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

Json cloud_json(const CloudFile& job, const std::filesystem::path& path) {
  return {{"file", path.filename().string()},
          {"rows", job.cloud.rows},
          {"cols", job.cloud.cols},
          {"frame_id", job.cloud.frame_id},
          {"world_from_cloud", pose_json(job.cloud.world_from_cloud)},
          {"layout", job.layout.empty() ? Json() : Json(job.layout)},
          {"columns", columns_json(job.fields)},
          {"image", image_json(job)}};
}

/// A factor, or one for each of the model's axes.
Json scale_json(const Instance& instance, const MeshSource& source) {
  if (source.stretch == Eigen::Vector3d::Ones()) return instance.scale;
  return vector_json(instance.scale * source.stretch);
}

Json instances_json(const CloudFile& job) {
  const Scene& scene = job.context.scene;
  Json instances = Json::array();
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const MeshSource& source = scene.sources.at(instance.mesh);
    Json entry = {{"name", instance.name},
                  {"id", instance.id},
                  {"class_id", instance.class_id},
                  {"class", scene.class_names.at(instance.class_id)},
                  {"model", source.path},
                  {"model_hash", source.hash.empty() ? Json() : Json(source.hash)},
                  {"metres_per_unit", source.metres_per_unit},
                  {"up", source.up.empty() ? Json() : Json(source.up)},
                  {"scale", scale_json(instance, source)}};
    entry["world_from_object"] = pose_json(job.frame.world_from_instance.at(i));
    instances.push_back(entry);
  }
  return instances;
}

/// In the coordinate frame of the cloud.
Json boxes_json(const CloudFile& job) {
  const Pose& world_from_sensor = job.frame.world_from_sensor;
  const bool is_own = job.cloud.world_from_cloud.matrix() == world_from_sensor.matrix();
  const Pose cloud_from_sensor =
      is_own ? Pose::Identity() : job.cloud.world_from_cloud.inverse() * world_from_sensor;
  Json boxes = Json::array();
  for (const ObjectBox& box : job.frame.boxes) {
    boxes.push_back(box_json(job.context.scene, box, cloud_from_sensor));
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

/// Indented, with lists of plain values on one line, so that matrices are readable.
void append_text(const Json& value, std::size_t indent, std::string& text) {
  const auto nested = [](const Json& part) { return part.is_structured(); };
  if (!value.is_object() && std::none_of(value.begin(), value.end(), nested)) {
    text += on_one_line(value);
    return;
  }
  const std::string margin(indent + 2, ' ');
  std::string_view before = value.is_object() ? "{\n" : "[\n";
  for (const auto& [key, part] : value.items()) {
    text.append(before).append(margin);
    if (value.is_object()) text += on_one_line(key) + ": ";
    append_text(part, indent + 2, text);
    before = ",\n";
  }
  text.append("\n").append(indent, ' ').append(value.is_object() ? "}" : "]");
}

}  // namespace

std::string sensor_to_json(const Sensor& sensor, const Beams& beams) {
  constexpr int kIndent = 2;
  Json json = sensor_json(sensor, beams);
  remove_negative_zeros(json);
  return json.dump(kIndent, ' ', false, Json::error_handler_t::replace);
}

std::string sidecar_text(const CloudFile& job, const std::filesystem::path& path) {
  Json all = {{"glidar", version()},
              {"command", command_json(job.context.command, path)},
              {"renderer", job.context.renderer},
              {"seed", job.frame.seed},
              {"frame", job.frame.number},
              {"frame_hash", frame_hash(job.frame)},
              {"stamp_ns", job.frame.stamp_ns},
              {"cloud", cloud_json(job, path)},
              {"sensor", sensor_json(job)},
              {"instances", instances_json(job)},
              {"boxes", boxes_json(job)},
              {"beams_by_status", status_json(job.frame)}};
  remove_negative_zeros(all);
  std::string text;
  append_text(all, 0, text);
  return text + "\n";
}

}  // namespace glidar
