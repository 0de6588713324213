// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/file_sink.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/file_text.hpp>
#include <glidar/core/unit_conversion.hpp>
#include <glidar/core/version.hpp>
#include <glidar/io/config/camera_info.hpp>
#include <glidar/io/config/field_json.hpp>
#include <glidar/io/config/json_numbers.hpp>
#include <glidar/io/config/sensor_keys.hpp>
#include <glidar/io/formats/box_json.hpp>
#include <glidar/io/formats/cloud_file.hpp>
#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/io/formats/format.hpp>
#include <glidar/io/formats/kitti_file.hpp>
#include <glidar/io/formats/las_crs.hpp>
#include <glidar/io/formats/sidecar.hpp>
#include <glidar/io/formats/stored_columns.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

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

std::string sensor_to_json(const Sensor& sensor, const Beams& beams) {
  constexpr int kIndent = 2;
  Json json = sensor_json(sensor, beams);
  remove_negative_zeros(json);
  return json.dump(kIndent, ' ', false, Json::error_handler_t::replace);
}

/// The JSON sidecar of a cloud at `path`; docs/files/sidecars.md lists its fields.
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

void check_writable(const std::filesystem::path& path, const std::filesystem::path& folder) {
  if (::faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) == 0) return;
  throw Error({path.string(), fmt::format("the folder {} cannot be written to", folder.string()),
               "", "write to another folder"});
}

void check_folder(const std::filesystem::path& path, const Format& format) {
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  std::error_code ignored;  // an inaccessible folder is treated as missing
  if (!path.has_filename()) {
    throw Error(
        {path.string(), "is the name of a folder", "a file name", "remove the trailing separator"});
  }
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw Error({path.string(), fmt::format("there is no folder {}", folder.string()), "",
                 "create it first, or correct the path"});
  }
  const bool wants_folder = format.info.is_folder;
  const bool is_folder = std::filesystem::is_directory(path, ignored);
  check_writable(path, wants_folder && is_folder ? path : folder);
  if (std::filesystem::exists(path, ignored) && is_folder != wants_folder) {
    throw Error({path.string(), wants_folder ? "is not a folder" : "is a folder",
                 wants_folder ? "a folder, or a new name" : "a file name", "choose another name"});
  }
  if (wants_folder) return;
  // a pipe or device would be replaced, not written to
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored))
    throw Error({path.string(), "is a pipe, a device or a socket", "a file name",
                 "choose another name, or -o - for standard output"});
}

void check_available(const std::filesystem::path& path, const FileFormat& format) {
  if (format.missing.empty()) return;
  throw Error({path.string(), fmt::format("this build does not write {} files", format.suffix), "",
               fmt::format("install {} and build again", format.missing)});
}

void check_column_sizes(const PointCloud& cloud, const std::filesystem::path& path) {
  for (const Column& column : cloud.columns) {
    const std::size_t wanted = cloud.size() * column.components.size();
    const std::size_t found =
        std::visit([](const auto& values) { return values.size(); }, column.values);
    if (found != wanted) {
      throw Error({path.string(), fmt::format("column {} has {} numbers", column.name, found),
                   fmt::format("{}", wanted), "fill every column for all rows x cols points"});
    }
  }
}

/// Names become members of archives, lines of headers and cells of tables.
void check_column_names(const PointCloud& cloud, const std::filesystem::path& path) {
  const auto check = [&](const std::string& name) {
    if (is_column_name(name)) return;
    throw Error({path.string(), fmt::format("a column '{}'", excerpt(name)),
                 fmt::format("names of 1 to {} letters, digits and _", kMaxColumnName_bytes),
                 "rename the column"});
  };
  for (const Column& column : cloud.columns) {
    check(column.name);
    for (const std::string& component : column.components) check(component);
  }
}

/// Readers find fields by their names.
void check_unique(std::span<const PointField> fields, const std::filesystem::path& path) {
  std::vector<std::string_view> names;
  for (const PointField& field : fields) names.push_back(field.name);
  std::ranges::sort(names);
  const auto same = std::ranges::adjacent_find(names);
  if (same == names.end()) return;
  throw Error({path.string(), fmt::format("two fields '{}'", *same), "each name once",
               "leave out or rename one of the columns"});
}

/// Columns that writers read with the types of make_point_cloud.
void check_column_types(const PointCloud& cloud, const std::filesystem::path& path) {
  const auto check = [&](std::string_view name, std::size_t components, Stored type,
                         const char* expected) {
    const Column* column = find_column(cloud, name);
    if (column == nullptr) return;
    if (column->components.size() == components && native_type(*column) == type) return;
    throw Error({path.string(), fmt::format("column {} has another type", name), expected,
                 "create the cloud with make_point_cloud"});
  };
  check("xyz", 3, Stored::f64, "three doubles per point");
  check("depth", 1, Stored::f64, "a double per point");
  check("intensity", 1, Stored::f32, "a float per point");
}

void check_needed_columns(const FileFormat& format, const PointCloud& cloud,
                          const std::filesystem::path& path) {
  std::vector<std::string> there;
  for (const Column& column : cloud.columns) there.push_back(column.name);
  for (const std::string& needed : format.columns) {
    if (find_column(cloud, needed) != nullptr) continue;
    throw Error({path.string(), fmt::format("the cloud has no column {}", needed),
                 fmt::format("{} needs {}", format.suffix, fmt::join(format.columns, " ")),
                 fmt::format("it has: {}; request {} too", fmt::join(there, " "), needed)});
  }
}

void check_picture_size(const CloudPictureOptions& options) {
  for (const std::uint32_t side : {options.width, options.height}) {
    if (side >= kMinPictureSide && side <= kMaxPictureSide) continue;
    throw Error({"picture size", fmt::format("{} x {} pixels", options.width, options.height),
                 fmt::format("sides from {} to {}", kMinPictureSide, kMaxPictureSide)});
  }
}

/// The target of a sink.
struct Target {
  std::filesystem::path path;
  int descriptor = -1;  ///< an open file; -1: the file `path`
};

class FormatSink : public FileSink {
 public:
  FormatSink(Target target, const Format& format, const FileSinkOptions& options,
             SidecarContext context, Report report)
      : target_(std::move(target)),
        format_(format),
        options_(options),
        context_(std::move(context)),
        report_(std::move(report)) {
    staged_.protect(context_.inputs);
  }

  [[nodiscard]] std::vector<std::filesystem::path> files() const override {
    std::vector<std::filesystem::path> all = {target_.path};
    if (target_.descriptor >= 0) return all;
    if (has_sidecar()) all.push_back(sidecar_path());
    if (format_.extra_path != nullptr) all.push_back(format_.extra_path(target_.path));
    return all;
  }

  void stage(const PointCloud& cloud, const Frame& frame) override {
    staged_.clear();
    check_column_names(cloud, target_.path);
    check_column_sizes(cloud, target_.path);
    check_column_types(cloud, target_.path);
    check_needed_columns(format_.info, cloud, target_.path);
    try {
      if (const auto ranges = range_image(cloud, frame)) {
        stage_points(*ranges, frame);
      } else {
        stage_points(cloud, frame);
      }
    } catch (...) {
      staged_.clear();
      throw;
    }
  }

  void commit() override { staged_.commit(); }

 private:
  [[nodiscard]] bool has_sidecar() const {
    return options_.sidecar && glidar::has_sidecar(format_);
  }
  [[nodiscard]] std::filesystem::path sidecar_path() const {
    return target_.path.string() + ".json";
  }

  [[nodiscard]] std::vector<PointField> fields_of(const PointCloud& cloud) const {
    return format_.fields != nullptr ? format_.fields(cloud) : std::vector<PointField>();
  }

  /// The cloud of an image with ranges in place of depths; empty: its depths are right.
  [[nodiscard]] std::optional<PointCloud> range_image(const PointCloud& cloud,
                                                      const Frame& frame) const {
    const bool has_depths =
        format_.content == Content::image && find_column(cloud, "depth") != nullptr;
    const bool is_array = format_.info.suffix == ".npy";
    const bool has_ranges = images_have_range(context_.sensor, context_.beams) ||
                            (is_array && !std::holds_alternative<Pinhole>(context_.sensor.optics));
    if (!has_depths || !has_ranges) return std::nullopt;
    PointCloud made = cloud;
    const auto is_named = [](const char* name) {
      return [name](const Column& column) { return column.name == name; };
    };
    if (std::ranges::any_of(made.columns, is_named("range"))) {
      std::erase_if(made.columns, is_named("depth"));
      return made;
    }
    std::vector<double> ranges_m = frame.range_m;
    for (double& range_m : ranges_m) range_m += context_.beams.range_offset_m;
    *std::ranges::find_if(made.columns, is_named("depth")) = {
        "range", {"range"}, std::move(ranges_m)};
    return made;
  }

  /// The meaning of an image's pixels: "depth ..." unless they are ranges.
  [[nodiscard]] std::string pixels_of(const PointCloud& cloud) const {
    std::string text = format_.pixels;
    if (text.starts_with("depth") && find_column(cloud, "depth") == nullptr)
      text.replace(0, 5, "range along the beam");
    return text;
  }

  void stage_points(const PointCloud& cloud, const Frame& frame) {
    const bool drops_invalid = format_.content == Content::kitti ||
                               format_.content == Content::hits ||
                               (format_.content == Content::points && options_.drop_invalid);
    if (drops_invalid) remove_invalid_points(cloud, hits_);
    const PointCloud& points = drops_invalid ? hits_ : cloud;
    if (format_.content == Content::kitti) {
      deliver(kitti_cloud(points, context_.sensor, context_.beams), frame);
    } else {
      deliver(points, frame);
    }
  }

  void deliver(const PointCloud& cloud, const Frame& frame) {
    // formats of hits have point records of their own
    if (options_.layout.empty() || !format_.info.takes_more || format_.content != Content::points) {
      const std::vector<PointField> fields = fields_of(cloud);
      store({cloud, frame, options_, context_, fields, {}, pixels_of(cloud)});
      warn_rounding(
          format_.rounding_warning != nullptr
              ? format_.rounding_warning(cloud)
              : rounding_warning(fields,
                                 "write .npz, .csv or .ply, which store distant points exactly"));
      return;
    }
    const PointCloud laid = apply_layout(cloud, options_.layout, context_.sensor, context_.beams);
    const std::vector<PointField> fields = native_fields(laid);
    store({laid, frame, options_, context_, fields, options_.layout, {}});
    const std::array points = {PointField{"x", find_column(cloud, "xyz"), 0, Stored::f32}};
    warn_rounding(rounding_warning(
        points, "without a layout .npz, .csv and .ply store distant points exactly"));
  }

  /// All files are complete before the first is renamed. The cloud's file is renamed last, so
  /// that the others exist when it appears.
  void store(const CloudFile& job) {
    const std::filesystem::path& path = target_.path;
    check_unique(job.fields, path);
    const bool is_stream = target_.descriptor >= 0;
    if (format_.write != nullptr) {
      AtomicFile& file = is_stream ? staged_.add(target_.descriptor, path) : staged_.add(path);
      format_.write(job, file);
      file.finish();
    }
    if (is_stream) return;
    if (format_.stage_extra_files != nullptr) format_.stage_extra_files(job, path, staged_);
    if (!has_sidecar()) return;
    AtomicFile& sidecar = staged_.add(sidecar_path());
    sidecar.write(sidecar_text(job, path));
    sidecar.finish();
  }

  void warn_rounding(const std::string& warning) const {
    if (!warning.empty()) report_.warn(target_.path.string() + ": " + warning);
  }

  Target target_;
  const Format& format_;
  FileSinkOptions options_;
  SidecarContext context_;
  Report report_;
  PointCloud hits_;  ///< of the last cloud; reuses its memory
  StagedFiles staged_;
};

void check(const FileSinkOptions& options) {
  if (!options.layout.empty()) find_layout(options.layout);
  if (!options.crs.empty()) crs_text(options.crs);
  check_picture_size(options.picture);
  if (options.depth_png_units_per_m > 0.0 && !std::isinf(options.depth_png_units_per_m)) return;
  throw Error({"depth_png_units_per_m", fmt::format("{}", options.depth_png_units_per_m),
               "a finite number above 0", "1000 for millimetres"});
}

}  // namespace

std::string frame_for(const FileFormat& format, const std::string& requested) {
  if (!requested.empty()) return requested;
  return format.is_survey ? "world" : "sensor";
}

std::span<const std::string> colour_by_names() {
  static const std::vector<std::string> kSinkNames = {
      "height", "range", "intensity", "ring", "class", "instance", "radial_velocity"};
  return kSinkNames;
}

void FileSink::write(const PointCloud& cloud, const Frame& frame) {
  stage(cloud, frame);
  commit();
}

std::unique_ptr<FileSink> make_file_sink(const std::filesystem::path& path,
                                         const FileSinkOptions& options,
                                         const SidecarContext& context, Report report) {
  const Format& format = find_format(path);
  check_available(path, format.info);
  const std::filesystem::path output = output_path(path);
  check_folder(output, format);
  check(options);
  return std::make_unique<FormatSink>(Target{output}, format, options, context, std::move(report));
}

std::unique_ptr<FileSink> make_stream_sink(int descriptor, const std::filesystem::path& name,
                                           const FileSinkOptions& options,
                                           const SidecarContext& context, Report report) {
  const Format& format = find_format(name);
  check_available(name, format.info);
  check(options);
  if (format.info.is_folder) {
    throw Error({name.string(), "is a folder of several files", "a format of one file",
                 "write to a folder instead"});
  }
  return std::make_unique<FormatSink>(Target{name, descriptor}, format, options, context,
                                      std::move(report));
}

}  // namespace glidar
