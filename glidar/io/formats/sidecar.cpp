// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/sidecar.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/config/json_error.hpp>
#include <glidar/io/config/json_text.hpp>
#include <glidar/io/files/content_hash.hpp>
#include <glidar/io/files/recorded_path.hpp>
#include <glidar/io/files/text_file.hpp>

#include <cmath>
#include <limits>
#include <type_traits>

namespace glidar {
namespace {

const TextFileKind kSidecar = {"the JSON file that glidar writes for a cloud", 512, ""};

/// A count of 32 bits.
std::uint64_t whole(const nlohmann::json& json) {
  constexpr std::uint64_t kMax = std::numeric_limits<std::uint32_t>::max();
  if (json.is_number_unsigned() && json.get<std::uint64_t>() <= kMax) {
    return json.get<std::uint64_t>();
  }
  throw nlohmann::json::type_error::create(302, shown_json(json) + " is not a count", &json);
}

CommandRecord read_command(const nlohmann::json& json, const std::filesystem::path& sidecar) {
  if (json.is_null()) return {};
  const auto arguments = json.at("arguments").get<std::vector<std::string>>();
  const auto folder = json.at("folder").get<std::string>();
  for (const std::string& argument : arguments) check_recorded_argument(sidecar, argument);
  check_recorded_path(sidecar, "folder", folder);
  return {.arguments = arguments, .folder = resolve_folder(sidecar, folder)};
}

Sidecar read(const nlohmann::json& json, const std::filesystem::path& path) {
  Sidecar sidecar;
  sidecar.path = path;
  sidecar.version = json.at("glidar").get<std::string>();
  sidecar.command = read_command(json.at("command"), path);
  sidecar.frame = static_cast<std::uint32_t>(whole(json.at("frame")));
  sidecar.frame_hash = json.at("frame_hash").get<std::string>();
  const nlohmann::json& cloud = json.at("cloud");
  sidecar.points = whole(cloud.at("rows")) * whole(cloud.at("cols"));
  sidecar.hits = whole(json.at("beams_by_status").at("hit"));
  for (const nlohmann::json& instance : json.at("instances")) {
    const nlohmann::json& hash = instance.at("model_hash");
    sidecar.model_hashes.push_back(hash.is_null() ? "" : hash.get<std::string>());
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
  try {
    return read(parse_json<nlohmann::json>(path.string(), read_text_file(path, kSidecar)), path);
  } catch (const nlohmann::json::exception& error) {
    const bool is_damaged = is_json_syntax_error(error.id);
    throw Error({.where = path.string(),
                 .found = (is_damaged ? "a damaged file: " : "not a sidecar of this version: ") +
                          json_error_text(error.id, error.what()),
                 .allowed = "the file that glidar wrote for the cloud",
                 .remedy = is_damaged ? "copy the file again, or write the cloud again"
                                      : "write the cloud again"});
  }
}

}  // namespace glidar
