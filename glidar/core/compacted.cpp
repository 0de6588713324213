// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/core/point_cloud.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

/// The points of one column whose index is in `kept`.
Column selected(const Column& column, const std::vector<std::size_t>& kept) {
  Column result{column.name, column.components, {}};
  const std::size_t width = column.components.size();
  std::visit(
      [&](const auto& values) {
        std::decay_t<decltype(values)> chosen;
        chosen.reserve(kept.size() * width);
        for (const std::size_t point : kept) {
          const auto first = values.begin() + static_cast<std::ptrdiff_t>(point * width);
          chosen.insert(chosen.end(), first, first + static_cast<std::ptrdiff_t>(width));
        }
        result.values = std::move(chosen);
      },
      column.values);
  return result;
}

}  // namespace

const Column* find_column(const PointCloud& cloud, std::string_view name) {
  const auto found = std::find_if(cloud.columns.begin(), cloud.columns.end(),
                                  [name](const Column& column) { return column.name == name; });
  return found == cloud.columns.end() ? nullptr : &*found;
}

PointCloud compacted(const PointCloud& cloud) {
  const Column* xyz = find_column(cloud, "xyz");
  if (xyz == nullptr) {
    throw Error({.where = "cloud",
                 .found = "no column 'xyz'",
                 .allowed = "a cloud with coordinates",
                 .remedy = "add the column"});
  }
  const auto& coordinates = std::get<std::vector<double>>(xyz->values);
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!std::isnan(coordinates[3 * i])) kept.push_back(i);
  }
  PointCloud result;
  result.rows = 1;
  result.cols = static_cast<std::uint32_t>(kept.size());
  result.frame_id = cloud.frame_id;
  result.world_from_cloud = cloud.world_from_cloud;
  for (const Column& column : cloud.columns) result.columns.push_back(selected(column, kept));
  return result;
}

}  // namespace glidar
