// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/core/point_cloud.hpp>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace glidar {
namespace {

/// Copies kWidth numbers of each kept point.
template <std::size_t kWidth, class Number>
void gather(const Number* from, std::span<const std::uint32_t> kept, Number* to) {
  for (const std::uint32_t point : kept) {
    // Not std::copy_n: it calls memmove() for each point.
    for (std::size_t c = 0; c < kWidth; ++c) to[c] = from[kWidth * point + c];
    to += kWidth;
  }
}

}  // namespace

void select_points(const Column& from, std::span<const std::uint32_t> kept, Column& to) {
  to.name = from.name;
  to.components = from.components;
  const std::size_t width = from.components.size();
  std::visit(
      [&](const auto& values) {
        using Values = std::decay_t<decltype(values)>;
        if (!std::holds_alternative<Values>(to.values)) to.values.template emplace<Values>();
        auto& chosen = std::get<Values>(to.values);
        chosen.resize(kept.size() * width);
        // The common widths as constants, for speed.
        if (width == 1) return gather<1>(values.data(), kept, chosen.data());
        if (width == 3) return gather<3>(values.data(), kept, chosen.data());
        auto* next = chosen.data();
        for (const std::uint32_t point : kept) {
          next = std::copy_n(values.data() + width * point, width, next);
        }
      },
      from.values);
}

const Column* find_column(const PointCloud& cloud, std::string_view name) {
  const auto found = std::find_if(cloud.columns.begin(), cloud.columns.end(),
                                  [name](const Column& column) { return column.name == name; });
  return found == cloud.columns.end() ? nullptr : &*found;
}

void remove_invalid_points(const PointCloud& cloud, PointCloud& hits) {
  const Column* xyz = find_column(cloud, "xyz");
  if (xyz == nullptr) {
    throw Error({.where = "cloud",
                 .found = "no column 'xyz'",
                 .allowed = "a cloud with coordinates",
                 .remedy = "add the column"});
  }
  const auto& coordinates = std::get<std::vector<double>>(xyz->values);
  std::vector<std::uint32_t> kept;
  kept.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!std::isnan(coordinates[3 * i])) kept.push_back(static_cast<std::uint32_t>(i));
  }
  hits.rows = 1;
  hits.cols = static_cast<std::uint32_t>(kept.size());
  hits.frame_id = cloud.frame_id;
  hits.world_from_cloud = cloud.world_from_cloud;
  hits.columns.resize(cloud.columns.size());
  for (std::size_t i = 0; i < cloud.columns.size(); ++i) {
    select_points(cloud.columns[i], kept, hits.columns[i]);
  }
}

}  // namespace glidar
