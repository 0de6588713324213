// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/sidecar.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/config/json_value.hpp>
#include <glidar/io/files/content_hash.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/io/files/paths.hpp>
#include <glidar/io/formats/file_sink.hpp>

#include <cmath>
#include <system_error>
#include <type_traits>

namespace glidar {
namespace {

const TextFileKind kSidecar = {"the JSON file that glidar writes for a cloud",
                               kMaxSidecarBytes >> 20U, ""};

CommandRecord read_command(const JsonValue& json, const std::filesystem::path& sidecar) {
  if (json.is_null()) return {};
  const std::vector<std::string> arguments = json.at("arguments").texts();
  const std::string folder = json.at("folder").text();
  for (const std::string& argument : arguments) check_recorded_argument(sidecar, argument);
  check_recorded_path(sidecar, "folder", folder);
  return {.arguments = arguments, .folder = resolve_folder(sidecar, folder)};
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& found,
                         const char* remedy) {
  throw Error({path.string(), found, "the file that glidar wrote for the cloud", remedy});
}

/// A sidecar's text and its content.
struct ReadJson {
  std::string text;
  nlohmann::json json;
};

ReadJson read_json(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) {
    throw Error({.where = path.string(),
                 .found = "there is no such file",
                 .allowed = "a cloud with its sidecar in the same folder",
                 .remedy = "write the cloud again, with -o and without --no-sidecar"});
  }
  ReadJson made{read_text_file(path, kSidecar), {}};
  made.json = parse_own_json(path.string(), made.text, [&](const std::string& found) {
    refuse(path, "a damaged file: " + found, "copy the file again, or write the cloud again");
  });
  return made;
}

RefuseJson refuse_value(const std::filesystem::path& path) {
  return [path](const std::string& found) {
    refuse(path, "not a sidecar of this version: " + found, "write the cloud again");
  };
}

/// What the frames of a run have in common.
void read_run(const JsonValue& json, const std::filesystem::path& path, Sidecar& sidecar) {
  sidecar.command = read_command(json.at("command"), path);
  for (const JsonValue& instance : json.at("instances").items()) {
    const JsonValue hash = instance.at("model_hash");
    sidecar.model_hashes.push_back(hash.is_null() ? "" : hash.text());
  }
}

/// The sidecar of the run that that of a frame names.
void read_run_of(const JsonValue& json, Sidecar& sidecar) {
  const std::string name = json.at("run").text();
  check_recorded_path(sidecar.path, "run", name);
  const std::filesystem::path path =
      std::filesystem::path(sidecar.path).replace_filename(std::filesystem::path(name).filename());
  const ReadJson run = read_json(path);
  const RefuseJson refuse = refuse_value(path);
  const JsonValue shared(run.json, refuse);
  if (shared.at("run_hash").text() != json.at("run_hash").text()) {
    throw Error({path.string(), "is of another run than " + sidecar.path.filename().string(), "",
                 "copy both again, or write the cloud again"});
  }
  read_run(shared, path, sidecar);
}

/// The points of the cloud in the sidecar of a frame, or of a run.
std::size_t read_points(const JsonValue& json, const std::string& cloud,
                        const std::filesystem::path& path) {
  for (const JsonValue& file : json.at("files").items()) {
    const std::uint64_t rows = file.at("rows").count<std::uint32_t>();
    const std::uint64_t points = rows * file.at("cols").count<std::uint32_t>();
    if (file.at("file").text() == cloud) return points;
  }
  throw Error({path.string(), "does not list " + excerpt(cloud), "", "write the cloud again"});
}

SidecarFrame read_frame(const JsonValue& json, std::size_t points) {
  return {.number = json.at("frame").count<std::uint32_t>(),
          .points = points,
          .hash = json.at("frame_hash").text()};
}

std::vector<SidecarFrame> read_frames(const JsonValue& json, const std::string& cloud,
                                      const std::filesystem::path& path) {
  const std::size_t all = read_points(json, cloud, path);
  if (!json.contains("frames")) return {read_frame(json, all)};
  std::vector<SidecarFrame> frames;
  for (const JsonValue& frame : json.at("frames").items())
    frames.push_back(
        read_frame(frame, frame.at("points").at(cloud.c_str()).count<std::uint32_t>()));
  if (frames.empty()) json.refuse("no frames");
  return frames;
}

}  // namespace

std::string relative_folder(const std::filesystem::path& file,
                            const std::filesystem::path& folder) {
  const auto here =
      std::filesystem::weakly_canonical(std::filesystem::absolute(file)).parent_path();
  return std::filesystem::weakly_canonical(folder).lexically_relative(here).generic_string();
}

std::filesystem::path resolve_folder(const std::filesystem::path& file, const std::string& seen) {
  return std::filesystem::weakly_canonical(std::filesystem::absolute(file)).parent_path() / seen;
}

std::string frame_hash(const Frame& frame) {
  ContentHash hash;
  const auto add = [&](const auto& column) {
    using Value = typename std::decay_t<decltype(column)>::value_type;
    hash.add(column.data(), column.size() * sizeof(Value));
  };
  add(frame.status);
  add(frame.intensity);
  const auto add_numbers = [&](std::vector<double> numbers) {
    for (double& number : numbers) {
      if (std::isnan(number)) number = 0.0;  // NaN has several representations
    }
    add(numbers);
  };
  add_numbers(frame.range_m);
  add_numbers(frame.radial_velocity_m_s);
  return hex(hash.value());
}

std::string listed_files(const std::filesystem::path& sidecar, const std::string& own) {
  const ReadJson read = read_json(sidecar);
  const RefuseJson refuse = refuse_value(sidecar);
  const JsonValue json(read.json, refuse);
  const auto measured = nlohmann::json::parse(own);
  for (const char* key : {"frame_hash", "stamp_ns", "world_from_sensor", "instances"}) {
    if (!json.contains(key) || read.json[key] != measured[key]) return "[]";
  }
  nlohmann::json files = nlohmann::json::array();
  const std::vector<JsonValue> listed = json.at("files").items();
  for (std::size_t i = 0; i < listed.size(); ++i) {
    const std::filesystem::path name = listed[i].at("file").text();
    std::error_code ignored;
    const bool is_there =
        name == name.filename() && std::filesystem::exists(sidecar.parent_path() / name, ignored);
    if (is_there) files.push_back(read.json["files"][i]);
  }
  return files.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

Sidecar read_sidecar(const std::filesystem::path& cloud) {
  Sidecar sidecar;
  sidecar.path = sidecar_path(cloud);
  const ReadJson read = read_json(sidecar.path);
  const RefuseJson refuse = refuse_value(sidecar.path);
  const JsonValue json(read.json, refuse);
  sidecar.version = json.at("glidar").text();
  if (json.contains("run")) {
    read_run_of(json, sidecar);
  } else {
    read_run(json, sidecar.path, sidecar);
  }
  sidecar.has_all_frames = json.contains("frames");
  sidecar.frames = read_frames(json, cloud.filename().string(), sidecar.path);
  return sidecar;
}

}  // namespace glidar
