// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/point_cloud.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/portable.hpp>
#include <glidar/math/thread_pool.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace glidar {
namespace {

/// The inputs of all columns.
struct ColumnSource {
  const Frame& frame;
  const Beams& beams;
  const Scene& scene;
  const Pose cloud_from_sensor;
  bool deskew;
  ThreadPool* thread_pool;
};

/// The column's numbers as vector<T> of `count` entries, reusing memory.
template <class T>
std::vector<T>& sized(Column& column, std::size_t count) {
  if (!std::holds_alternative<std::vector<T>>(column.values))
    column.values.emplace<std::vector<T>>();
  auto& values = std::get<std::vector<T>>(column.values);
  values.resize(count);
  return values;
}

/// Calls body(begin, end) for ranges that cover all points.
template <class Body>
void for_pieces(const ColumnSource& source, const Body& body) {
  constexpr std::size_t kPoints = 16384;  // fewer are not worth a thread
  const std::size_t size = source.beams.size();
  if (source.thread_pool == nullptr) return body(0, size);
  source.thread_pool->parallel_for(size, kPoints, body);
}

/// One number per point, from a function of the beam's index.
template <class T, class Function>
void fill_each(const ColumnSource& source, Column& column, Function value_of) {
  T* const values = sized<T>(column, source.beams.size()).data();
  for_pieces(source, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) values[i] = value_of(i);
  });
}

/// The components of a fixed-size vector per point, from a function of the beam's index.
template <class T, int kSize, class Function>
void fill_vectors(const ColumnSource& source, Column& column, Function vector_of) {
  T* const values = sized<T>(column, source.beams.size() * kSize).data();
  for_pieces(source, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Eigen::Map<Eigen::Matrix<T, kSize, 1>> target(values + i * kSize);
      target = vector_of(i);
    }
  });
}

/// A known column: its fields, the hit columns that it requires, and the function that fills it.
struct ColumnKind {
  std::string name;
  std::vector<std::string> components;
  HitColumnMask needs;
  void (*fill)(const ColumnSource&, Column&);
};

using Vectors = std::vector<Eigen::Vector3d>;

/// The points at these ranges on the beams; NaN where there is no range.
void fill_points(const ColumnSource& s, const std::vector<double>& ranges_m,
                 const Vectors& directions, const Vectors& origins_m, Column& column) {
  const Eigen::Vector3d no_point = Eigen::Vector3d::Constant(kNaN);
  const auto fill = [&](const auto& to_cloud) {
    fill_vectors<double, 3>(s, column, [&](std::size_t i) -> Eigen::Vector3d {
      if (std::isnan(ranges_m[i])) return no_point;
      Eigen::Vector3d in_sensor = ranges_m[i] * directions[i];
      if (!origins_m.empty()) in_sensor += origins_m[i];
      return to_cloud(in_sensor);
    });
  };
  if (s.cloud_from_sensor.matrix() == Eigen::Matrix4d::Identity()) {
    // The sum makes zeros positive, as the general case does.
    return fill([](const Eigen::Vector3d& point) -> Eigen::Vector3d {
      return point + Eigen::Vector3d::Zero();
    });
  }
  const Eigen::Matrix3d rotation = s.cloud_from_sensor.linear();
  const Eigen::Vector3d translation = s.cloud_from_sensor.translation();
  fill([&](const Eigen::Vector3d& point) -> Eigen::Vector3d {
    return rotation * point + translation;
  });
}

void fill_xyz(const ColumnSource& s, Column& column) {
  const Frame::Deskewed& moved = s.frame.deskewed;
  const bool use_moved = s.deskew && !moved.directions.empty();
  fill_points(s, s.frame.range_m, use_moved ? moved.directions : s.beams.directions,
              use_moved ? moved.origins_m : s.beams.origins_m, column);
}

void fill_true_xyz(const ColumnSource& s, Column& column) {
  const Frame::Deskewed& moved = s.frame.deskewed;
  const Vectors& directions = s.frame.true_directions;
  if (moved.directions.empty()) {
    return fill_points(s, s.frame.ground_truth.range_m,
                       directions.empty() ? s.beams.directions : directions, s.beams.origins_m,
                       column);
  }
  fill_points(s, s.frame.ground_truth.range_m,
              moved.true_directions.empty() ? moved.directions : moved.true_directions,
              moved.origins_m, column);
}

void fill_true_range(const ColumnSource& s, Column& column) {
  fill_each<double>(s, column, [&](std::size_t i) {
    return s.frame.ground_truth.range_m[i] + s.beams.range_offset_m;
  });
}

void fill_sigma(const ColumnSource& s, Column& column) {
  const std::vector<float>& sigmas_m = s.frame.sigma_m;
  fill_each<float>(s, column, [&](std::size_t i) { return sigmas_m.empty() ? 0.0F : sigmas_m[i]; });
}

void fill_radial_velocity(const ColumnSource& s, Column& column) {
  const std::vector<double>& velocities_m_s = s.frame.radial_velocity_m_s;
  fill_each<double>(
      s, column, [&](std::size_t i) { return velocities_m_s.empty() ? kNaN : velocities_m_s[i]; });
}

void fill_true_radial_velocity(const ColumnSource& s, Column& column) {
  fill_each<double>(s, column, [&](std::size_t i) { return s.frame.true_radial_velocity_m_s[i]; });
}

void fill_intensity(const ColumnSource& s, Column& column) {
  fill_each<float>(s, column, [&](std::size_t i) { return s.frame.intensity[i]; });
}

void fill_range(const ColumnSource& s, Column& column) {
  const double offset_m = s.beams.range_offset_m;
  fill_each<double>(s, column, [&](std::size_t i) { return s.frame.range_m[i] + offset_m; });
}

void fill_depth(const ColumnSource& s, Column& column) {
  fill_each<double>(s, column,
                    [&](std::size_t i) { return depth_m(s.beams, i, s.frame.range_m[i]); });
}

void fill_directions(const ColumnSource& s, Column& column,
                     const std::vector<Eigen::Vector3f>& normals) {
  const Eigen::Matrix3f rotation = s.cloud_from_sensor.linear().cast<float>();
  const std::vector<Eigen::Quaternionf>& turns = s.frame.deskewed.start_from_sensor;
  const bool turn = s.deskew && !turns.empty();
  fill_vectors<float, 3>(s, column, [&](std::size_t i) -> Eigen::Vector3f {
    return turn ? Eigen::Vector3f(rotation * (turns[i] * normals[i]))
                : Eigen::Vector3f(rotation * normals[i]);
  });
}

void fill_normal(const ColumnSource& s, Column& column) {
  fill_directions(s, column, s.frame.ground_truth.normal);
}

void fill_shading_normal(const ColumnSource& s, Column& column) {
  fill_directions(s, column, s.frame.ground_truth.shading_normal);
}

void fill_incidence(const ColumnSource& s, Column& column) {
  fill_each<float>(s, column, [&](std::size_t i) {
    const double cosine = std::min(s.frame.ground_truth.cos_incidence[i], 1.0F);
    return static_cast<float>(portable_acos(cosine));
  });
}

/// A member of the instance that each beam hits.
template <class Function>
void fill_of_instance(const ColumnSource& s, Column& column, Function number_of) {
  fill_each<std::uint32_t>(s, column, [&](std::size_t i) {
    const std::uint32_t instance = s.frame.ground_truth.instance[i];
    return instance == kInvalidId ? kInvalidId : number_of(s.scene.instances[instance]);
  });
}

void fill_instance(const ColumnSource& s, Column& column) {
  fill_of_instance(s, column, [](const Instance& instance) { return instance.id; });
}

void fill_class(const ColumnSource& s, Column& column) {
  fill_of_instance(s, column, [](const Instance& instance) { return instance.class_id; });
}

void fill_primitive(const ColumnSource& s, Column& column) {
  fill_each<std::uint32_t>(s, column,
                           [&](std::size_t i) { return s.frame.ground_truth.primitive[i]; });
}

void fill_barycentrics(const ColumnSource& s, Column& column) {
  fill_vectors<float, 2>(s, column,
                         [&](std::size_t i) { return s.frame.ground_truth.barycentrics[i]; });
}

void fill_colour(const ColumnSource& s, Column& column) {
  fill_vectors<float, 3>(s, column, [&](std::size_t i) { return s.frame.ground_truth.colour[i]; });
}

void fill_object_point(const ColumnSource& s, Column& column) {
  fill_vectors<double, 3>(s, column,
                          [&](std::size_t i) { return s.frame.ground_truth.object_point_m[i]; });
}

void fill_status(const ColumnSource& s, Column& column) {
  fill_each<std::uint8_t>(
      s, column, [&](std::size_t i) { return static_cast<std::uint8_t>(s.frame.status[i]); });
}

void fill_row(const ColumnSource& s, Column& column) {
  fill_each<std::uint32_t>(s, column, [&](std::size_t i) {
    return static_cast<std::uint32_t>(i % s.beams.firings() / s.beams.cols);
  });
}

void fill_col(const ColumnSource& s, Column& column) {
  fill_each<std::uint32_t>(
      s, column, [&](std::size_t i) { return static_cast<std::uint32_t>(i % s.beams.cols); });
}

void fill_ring(const ColumnSource& s, Column& column) {
  fill_each<std::uint16_t>(s, column, [&](std::size_t i) { return ring_of(s.beams, i); });
}

void fill_return(const ColumnSource& s, Column& column) {
  fill_each<std::uint8_t>(
      s, column, [&](std::size_t i) { return static_cast<std::uint8_t>(i / s.beams.firings()); });
}

void fill_return_source(const ColumnSource& s, Column& column) {
  const std::vector<ReturnSource>& sources = s.frame.return_source;
  fill_each<std::uint8_t>(s, column, [&](std::size_t i) {
    const ReturnSource source = sources.empty() ? ReturnSource::surface : sources[i];
    return static_cast<std::uint8_t>(s.frame.status[i] == Status::hit ? source
                                                                      : ReturnSource::none);
  });
}

void fill_time(const ColumnSource& s, Column& column) {
  fill_each<std::uint32_t>(s, column, [&](std::size_t i) {
    return s.beams.times_ns.empty() ? 0U : s.beams.times_ns[i];
  });
}

void fill_azimuth(const ColumnSource& s, Column& column) {
  const SensorAxes axes = axes_of(s.beams);
  fill_each<double>(s, column,
                    [&](std::size_t i) { return azimuth_rad(axes, s.beams.directions[i]); });
}

void fill_elevation(const ColumnSource& s, Column& column) {
  const SensorAxes axes = axes_of(s.beams);
  fill_each<double>(s, column,
                    [&](std::size_t i) { return elevation_rad(axes, s.beams.directions[i]); });
}

void fill_stamp(const ColumnSource& s, Column& column) {
  fill_each<std::int64_t>(s, column, [&](std::size_t i) {
    return s.frame.stamp_ns + (s.beams.times_ns.empty() ? 0 : s.beams.times_ns[i]);
  });
}

void fill_sensor_pose(const ColumnSource& s, Column& column) {
  fill_vectors<double, 7>(s, column,
                          [&](std::size_t i) { return s.frame.beam_poses.world_from_sensor[i]; });
}

void fill_object_pose(const ColumnSource& s, Column& column) {
  fill_vectors<double, 7>(s, column,
                          [&](std::size_t i) { return s.frame.beam_poses.world_from_object[i]; });
}

/// "sensor_pose_x" ... "sensor_pose_qz".
std::vector<std::string> pose_fields(const std::string& of) {
  std::vector<std::string> names;
  for (const char* part : {"x", "y", "z", "qw", "qx", "qy", "qz"})
    names.push_back(of + "_pose_" + part);
  return names;
}

/// All columns, in the order in which files list them.
std::span<const ColumnKind> column_kinds() {
  static const std::vector<ColumnKind> kinds = {
      {"xyz", {"x", "y", "z"}, {}, fill_xyz},
      {"true_xyz", {"true_x", "true_y", "true_z"}, {}, fill_true_xyz},
      {"intensity", {"intensity"}, {}, fill_intensity},
      {"range", {"range"}, {}, fill_range},
      {"true_range", {"true_range"}, {}, fill_true_range},
      {"sigma", {"sigma"}, {}, fill_sigma},
      {"radial_velocity", {"radial_velocity"}, {}, fill_radial_velocity},
      {"true_radial_velocity",
       {"true_radial_velocity"},
       {.radial_velocity = true},
       fill_true_radial_velocity},
      {"depth", {"depth"}, {}, fill_depth},
      {"normal", {"normal_x", "normal_y", "normal_z"}, {.normal = true}, fill_normal},
      {"shading_normal",
       {"shading_normal_x", "shading_normal_y", "shading_normal_z"},
       {.shading_normal = true},
       fill_shading_normal},
      {"incidence", {"incidence"}, {.incidence = true}, fill_incidence},
      {"instance", {"instance"}, {}, fill_instance},
      {"class", {"class"}, {}, fill_class},
      {"primitive", {"primitive"}, {}, fill_primitive},
      {"barycentrics", {"bary_1", "bary_2"}, {.barycentrics = true}, fill_barycentrics},
      {"colour", {"red", "green", "blue"}, {.colour = true}, fill_colour},
      {"object_point",
       {"object_x", "object_y", "object_z"},
       {.object_point = true},
       fill_object_point},
      {"status", {"status"}, {}, fill_status},
      {"row", {"row"}, {}, fill_row},
      {"col", {"col"}, {}, fill_col},
      {"ring", {"ring"}, {}, fill_ring},
      {"time", {"time"}, {}, fill_time},
      {"return", {"return"}, {}, fill_return},
      {"return_source", {"return_source"}, {}, fill_return_source},
      {"azimuth", {"azimuth"}, {}, fill_azimuth},
      {"elevation", {"elevation"}, {}, fill_elevation},
      {"stamp", {"stamp"}, {}, fill_stamp},
      {"sensor_pose", pose_fields("sensor"), {.poses = true}, fill_sensor_pose},
      {"object_pose", pose_fields("object"), {.poses = true}, fill_object_pose},
  };
  return kinds;
}

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
