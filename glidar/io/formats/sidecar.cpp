// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/sidecar.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/config/json_value.hpp>
#include <glidar/io/files/content_hash.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/io/files/paths.hpp>

#include <cmath>
#include <type_traits>

namespace glidar {
namespace {

const TextFileKind kSidecar = {"the JSON file that glidar writes for a cloud", 512, ""};

CommandRecord read_command(const JsonValue& json, const std::filesystem::path& sidecar) {
  if (json.is_null()) return {};
  const std::vector<std::string> arguments = json.at("arguments").texts();
  const std::string folder = json.at("folder").text();
  for (const std::string& argument : arguments) check_recorded_argument(sidecar, argument);
  check_recorded_path(sidecar, "folder", folder);
  return {.arguments = arguments, .folder = resolve_folder(sidecar, folder)};
}

Sidecar read(const JsonValue& json, const std::filesystem::path& path) {
  Sidecar sidecar;
  sidecar.path = path;
  sidecar.version = json.at("glidar").text();
  sidecar.command = read_command(json.at("command"), path);
  sidecar.frame = json.at("frame").count<std::uint32_t>();
  sidecar.frame_hash = json.at("frame_hash").text();
  const JsonValue cloud = json.at("cloud");
  sidecar.points = std::uint64_t{cloud.at("rows").count<std::uint32_t>()} *
                   cloud.at("cols").count<std::uint32_t>();
  sidecar.hits = json.at("beams_by_status").at("hit").count<std::uint32_t>();
  for (const JsonValue& instance : json.at("instances").items()) {
    const JsonValue hash = instance.at("model_hash");
    sidecar.model_hashes.push_back(hash.is_null() ? "" : hash.text());
  }
  return sidecar;
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

Sidecar read_sidecar(const std::filesystem::path& cloud) {
  const std::filesystem::path path = cloud.string() + ".json";
  if (!std::filesystem::exists(path)) {
    throw Error({.where = path.string(),
                 .found = "there is no such file",
                 .allowed = "a cloud with its sidecar in the same folder",
                 .remedy = "write the cloud again, with -o and without --no-sidecar"});
  }
  const auto refuse = [&](const std::string& found, const char* remedy) {
    throw Error({path.string(), found, "the file that glidar wrote for the cloud", remedy});
  };
  const std::string text = read_text_file(path, kSidecar);
  const nlohmann::json json = parse_own_json(path.string(), text, [&](const std::string& found) {
    refuse("a damaged file: " + found, "copy the file again, or write the cloud again");
  });
  const RefuseJson refuse_value = [&](const std::string& found) {
    refuse("not a sidecar of this version: " + found, "write the cloud again");
  };
  return read(JsonValue(json, refuse_value), path);
}

}  // namespace glidar
