// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/bag.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/bags/bag_formats.hpp>
#include <glidar/io/bags/bag_records.hpp>
#include <glidar/io/bags/bag_storage.hpp>

#include <fmt/format.h>

#include <system_error>

namespace glidar::bags {
namespace {

/// Without the separators that shells append to folders.
std::filesystem::path without_separators(const std::filesystem::path& path) {
  return path.has_filename() ? path : path.parent_path();
}

/// Throws Error when the suffix names no bag.
bool is_rosbag2(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_directory(path, ignored) || bag_format_for(path) == BagFormat::rosbag2;
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
  const std::string stem = name.stem().string();
  throw Error(
      {path.string(), "bags of ROS 1 are not written", ".mcap .rosbag2",
       fmt::format("write {0}.rosbag2, then `rosbags-convert --src {0}.rosbag2 --dst {0}.bag`"
                   " (pip install rosbags)",
                   stem)});
}

std::unique_ptr<BagReader> open_bag(const std::filesystem::path& path) {
  const std::filesystem::path name = without_separators(path);
  // Here, because the sandboxed process cannot look for files of a similar name.
  if (is_rosbag2(name)) {
    require_metadata(name);
  } else {
    BagFile file(name);
  }
  return receive_bag(start_decoder(kBagDecoder, name));
}

std::unique_ptr<BagReader> open_bag_unconfined(const std::filesystem::path& path) {
  if (is_rosbag2(path)) return open_rosbag2(path);
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  auto budget = std::make_shared<InputBudget>(error ? 0 : size);
  if (bag_format_for(path) == BagFormat::mcap) return open_mcap(path, std::move(budget));
  return open_rosbag1(path, std::move(budget));
}

}  // namespace glidar::bags
