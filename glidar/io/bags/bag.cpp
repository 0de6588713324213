// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/bag.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/bags/mcap_reader.hpp>
#include <glidar/io/bags/mcap_writer.hpp>
#include <glidar/io/bags/rosbag1_reader.hpp>
#include <glidar/io/bags/rosbag1_writer.hpp>
#include <glidar/io/bags/rosbag2_reader.hpp>
#include <glidar/io/bags/rosbag2_writer.hpp>

#include <system_error>

namespace glidar::bags {
namespace {

/// Without the separators that shells append to folders.
std::filesystem::path without_separators(const std::filesystem::path& path) {
  return path.has_filename() ? path : path.parent_path();
}

}  // namespace

bool is_bag_name(const std::filesystem::path& path) {
  const std::string suffix = without_separators(path).extension().string();
  return suffix == ".mcap" || suffix == ".bag" || suffix == ".rosbag2";
}

bool is_bag_path(const std::filesystem::path& path) {
  if (is_bag_name(path)) return true;
  std::error_code ignored;
  return std::filesystem::is_regular_file(path / "metadata.yaml", ignored);
}

BagFormat bag_format_for(const std::filesystem::path& path) {
  const std::string suffix = without_separators(path).extension().string();
  if (suffix == ".mcap") return BagFormat::mcap;
  if (suffix == ".rosbag2") return BagFormat::rosbag2;
  if (suffix == ".bag") return BagFormat::rosbag1;
  throw Error({path.string(), "the suffix '" + suffix + "' is no bag's", ".mcap .rosbag2 .bag",
               "name the bag with one of them"});
}

std::unique_ptr<BagWriter> create_bag(const std::filesystem::path& path,
                                      const BagOptions& options) {
  const std::filesystem::path name = without_separators(path);
  switch (bag_format_for(name)) {
    case BagFormat::mcap:
      return std::make_unique<McapWriter>(name, options);
    case BagFormat::rosbag2:
      return create_rosbag2(name, options);
    case BagFormat::rosbag1:
      break;
  }
  return std::make_unique<Rosbag1Writer>(name, options);
}

std::unique_ptr<BagReader> open_bag(const std::filesystem::path& path) {
  const std::filesystem::path name = without_separators(path);
  std::error_code ignored;
  if (std::filesystem::is_directory(name, ignored)) return open_rosbag2(name);
  switch (bag_format_for(name)) {
    case BagFormat::mcap:
      return open_mcap(name);
    case BagFormat::rosbag2:
      return open_rosbag2(name);
    case BagFormat::rosbag1:
      break;
  }
  return open_rosbag1(name);
}

}  // namespace glidar::bags
