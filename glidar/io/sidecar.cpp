// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/sidecar.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/text_file.hpp>

#include <nlohmann/json.hpp>

namespace glidar {
namespace {

using Json = nlohmann::json;

const TextFileKind kSidecar = {"the JSON file that glidar writes beside a cloud", 512, ""};

CommandRecord read_command(const Json& told, const std::filesystem::path& sidecar) {
  if (told.is_null()) return {};
  const std::filesystem::path folder = told.at("folder").get<std::string>();
  return {.arguments = told.at("arguments").get<std::vector<std::string>>(),
          .folder = std::filesystem::absolute(sidecar).parent_path() / folder};
}

Sidecar read(const Json& told, const std::filesystem::path& path) {
  Sidecar sidecar;
  sidecar.path = path;
  sidecar.version = told.at("glidar").get<std::string>();
  sidecar.command = read_command(told.at("command"), path);
  sidecar.frame = told.at("frame").get<std::uint32_t>();
  const Json& cloud = told.at("cloud");
  sidecar.points = cloud.at("rows").get<std::size_t>() * cloud.at("cols").get<std::size_t>();
  sidecar.hits = told.at("beams_by_status").at("hit").get<std::size_t>();
  for (const Json& instance : told.at("instances")) {
    const Json& hash = instance.at("model_hash");
    sidecar.model_hashes.push_back(hash.is_null() ? "" : hash.get<std::string>());
  }
  return sidecar;
}

}  // namespace

Sidecar read_sidecar(const std::filesystem::path& cloud) {
  const std::filesystem::path path = cloud.string() + ".json";
  if (!std::filesystem::exists(path)) {
    throw Error({.where = path.string(),
                 .found = "there is no such file",
                 .allowed = "a cloud with its sidecar beside it",
                 .remedy = "write the cloud again, without --no-sidecar"});
  }
  try {
    return read(Json::parse(read_text_file(path, kSidecar)), path);
  } catch (const Json::exception& error) {
    throw Error({.where = path.string(),
                 .found = std::string("not a sidecar of this version: ") + error.what(),
                 .allowed = "the file that glidar wrote beside the cloud",
                 .remedy = "write the cloud again"});
  }
}

}  // namespace glidar
