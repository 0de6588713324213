// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/reply_size.hpp>

#include <glidar/core/point_cloud.hpp>

#include <algorithm>
#include <array>
#include <string_view>

namespace glidar::app {
namespace {

struct ColumnSize {
  std::string_view name;
  std::int64_t bytes;  ///< of a point
};

/// As documented for make_point_cloud(); reply_size_test.cpp compares all of them with clouds.
constexpr std::array kSizes = {
    ColumnSize{"xyz", 24},
    ColumnSize{"true_xyz", 24},
    ColumnSize{"intensity", 4},
    ColumnSize{"range", 8},
    ColumnSize{"true_range", 8},
    ColumnSize{"sigma", 4},
    ColumnSize{"radial_velocity", 8},
    ColumnSize{"true_radial_velocity", 8},
    ColumnSize{"depth", 8},
    ColumnSize{"normal", 12},
    ColumnSize{"shading_normal", 12},
    ColumnSize{"incidence", 4},
    ColumnSize{"instance", 4},
    ColumnSize{"class", 4},
    ColumnSize{"primitive", 4},
    ColumnSize{"barycentrics", 8},
    ColumnSize{"colour", 12},
    ColumnSize{"object_point", 24},
    ColumnSize{"status", 1},
    ColumnSize{"row", 4},
    ColumnSize{"col", 4},
    ColumnSize{"ring", 2},
    ColumnSize{"time", 4},
    ColumnSize{"return", 1},
    ColumnSize{"return_source", 1},
    ColumnSize{"azimuth", 8},
    ColumnSize{"elevation", 8},
    ColumnSize{"stamp", 8},
    ColumnSize{"sensor_pose", 56},
    ColumnSize{"object_pose", 56},
};

constexpr std::int64_t kMax_bytes = 56;
constexpr std::int64_t kHead_bytes = 120;

}  // namespace

std::int64_t point_bytes(std::span<const std::string> columns) {
  (void)glidar::hit_columns_for(columns);  // throws on an unknown name
  std::int64_t bytes = 0;
  for (const std::string& name : columns) {
    const auto* const found = std::find_if(
        kSizes.begin(), kSizes.end(), [&](const ColumnSize& size) { return size.name == name; });
    bytes += found == kSizes.end() ? kMax_bytes : found->bytes;
  }
  return bytes;
}

std::int64_t reply_bytes(std::span<const std::string> columns, std::size_t points,
                         std::size_t clouds) {
  const std::int64_t cloud = static_cast<std::int64_t>(points) * point_bytes(columns) + kHead_bytes;
  return static_cast<std::int64_t>(clouds) * cloud;
}

}  // namespace glidar::app
