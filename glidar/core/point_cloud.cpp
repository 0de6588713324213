// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/point_cloud.hpp>

#include <glidar/core/cloud_columns.hpp>
#include <glidar/core/error.hpp>
#include <glidar/core/excerpt.hpp>

#include <string>

namespace glidar {
namespace {

template <class Grid>
std::string shape(const Grid& grid) {
  return std::to_string(grid.rows) + " x " + std::to_string(grid.cols);
}

const ColumnKind& kind_named(std::string_view name) {
  for (const ColumnKind& kind : column_kinds()) {
    if (kind.name == name) return kind;
  }
  std::string allowed;
  for (const std::string& known : cloud_column_names())
    allowed += (allowed.empty() ? "" : " ") + known;
  const std::string nearest = closest_match(name, cloud_column_names());
  throw Error({.where = "cloud column",
               .found = "'" + excerpt(name) + "' is not known",
               .allowed = allowed,
               .remedy = nearest.empty() ? "" : "did you mean '" + nearest + "'?"});
}

/// True if the frame has the hit columns that the cloud column requires.
bool has(const Frame& frame, const HitColumnMask& needs) {
  const Hits& hits = frame.ground_truth;
  const std::size_t size = frame.range_m.size();
  const auto kept = [size](bool needed, std::size_t found) { return !needed || found == size; };
  return kept(needs.normal, hits.normal.size()) &&
         kept(needs.shading_normal, hits.shading_normal.size()) &&
         kept(needs.incidence, hits.cos_incidence.size()) &&
         kept(needs.barycentrics, hits.barycentrics.size()) &&
         kept(needs.colour, hits.colour.size()) &&
         kept(needs.object_point, hits.object_point_m.size()) &&
         kept(needs.poses, frame.beam_poses.world_from_sensor.size()) &&
         kept(needs.radial_velocity, frame.true_radial_velocity_m_s.size());
}

}  // namespace

std::span<const std::string> cloud_column_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const ColumnKind& kind : column_kinds()) all.push_back(kind.name);
    return all;
  }();
  return names;
}

HitColumnMask hit_columns_for(std::span<const std::string> column_names) {
  HitColumnMask hit_columns;
  for (const std::string& name : column_names) hit_columns = hit_columns | kind_named(name).needs;
  return hit_columns;
}

void make_point_cloud(const Frame& frame, const Beams& beams, const Scene& scene,
                      const OutputFrame& target_frame, std::span<const std::string> column_names,
                      PointCloud& cloud) {
  if (beams.rows != frame.rows || beams.cols != frame.cols) {
    throw Error({.where = "point cloud",
                 .found = "a frame of " + shape(frame) + " and beams of " + shape(beams),
                 .allowed = "the beams with which the frame was measured",
                 .remedy = "pass Simulator::beams() of the frame's number"});
  }
  cloud.rows = frame.rows;
  cloud.cols = frame.cols;
  cloud.frame_id = target_frame.frame_id;
  cloud.world_from_cloud = frame.world_from_sensor * target_frame.cloud_from_sensor.inverse();
  cloud.columns.resize(column_names.size());
  const ColumnSource source{frame,
                            beams,
                            scene,
                            target_frame.cloud_from_sensor,
                            target_frame.deskew,
                            target_frame.thread_pool};
  for (std::size_t c = 0; c < column_names.size(); ++c) {
    const ColumnKind& kind = kind_named(column_names[c]);
    if (!has(frame, kind.needs)) {
      throw Error(
          {.where = "cloud column '" + kind.name + "'",
           .found = "the frame was cast without it",
           .remedy = "measure with this column: hit_columns_for() in C++, columns= in Python"});
    }
    cloud.columns[c].name = kind.name;
    cloud.columns[c].components = kind.components;
    kind.fill(source, cloud.columns[c]);
  }
}

}  // namespace glidar
