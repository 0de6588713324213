// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/core/output_frame.hpp>
#include <glidar/core/scene.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace glidar {

/// One named quantity of every point: components.size() numbers per point, point by point.
struct Column {
  std::string name;                     ///< e.g. "normal"
  std::vector<std::string> components;  ///< field names, e.g. normal_x normal_y normal_z
  std::variant<std::vector<float>, std::vector<double>, std::vector<std::uint8_t>,
               std::vector<std::uint16_t>, std::vector<std::uint32_t>, std::vector<std::int64_t>>
      values;
};

/// Columns of a frame in a named coordinate frame. Organised (rows x cols, row-major; a miss has
/// NaN coordinates) unless remove_invalid_points() has left one row.
struct PointCloud {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::string frame_id;
  Pose world_from_cloud = Pose::Identity();  ///< pose of frame_id
  std::vector<Column> columns;

  [[nodiscard]] std::size_t size() const { return std::size_t{rows} * cols; }
};

/// Names that make_point_cloud() accepts, in the order in which files list them:
/// xyz true_xyz intensity range true_range sigma radial_velocity true_radial_velocity depth normal
/// shading_normal incidence instance class primitive barycentrics colour object_point status row
/// col ring time return return_source azimuth elevation stamp sensor_pose object_pose
std::span<const std::string> cloud_column_names();

/// The optional hit columns that these cloud columns require. Throws Error for an unknown name.
HitColumnMask hit_columns_for(std::span<const std::string> column_names);

/// Fills `cloud` with the named columns of a frame, reusing its memory.
///  xyz           f64 x3, metres in `target_frame`, from the measured range; NaN unless a hit
///  true_xyz      f64 x3, the same from the ground truth range, whether reported or not, along the
///                beam as fired
///  intensity     f32
///  range, depth  f64, metres, measured; NaN unless a hit. Ranges include Beams::range_offset_m,
///                which does not affect coordinates
///  true_range    f64, metres, ground truth, also with range_offset_m; NaN for a miss
///  sigma         f32, metres, standard deviation of the range's random error
///  radial_velocity  f64, m/s, measured, positive for what moves away; NaN unless a hit, or if the
///                sensor does not measure it
///  true_radial_velocity  f64, m/s, ground truth; NaN for a miss
///  normal, shading_normal  f32 x3, unit, in `target_frame`
///  incidence     f32, radians
///  instance, class  u32, the instance's id and class_id; kInvalidId for a miss
///  primitive     u32, triangle of the mesh; kInvalidId for a miss
///  barycentrics  f32 x2; colour f32 x3; object_point f64 x3 in the object's own frame
///  status        u8, see Status; row, col u32
///  ring          u16, channel number; time u32, ns since the frame's start
///  return        u8, rank of the return, from 0; return_source u8, see ReturnSource
///  azimuth, elevation  f64, radians, of the beam without pointing noise in the sensor frame, see
///                azimuth_rad() and elevation_rad()
///  stamp         i64, ns, firing time of the beam: the frame's stamp_ns plus `time`
///  sensor_pose   f64 x7, world_from_sensor at the firing time: metres, quaternion w x y z
///  object_pose   f64 x7, world_from_object of the instance hit, at the firing time, without scale;
///                NaN for a miss
/// Throws Error for an unknown column, for a frame that was cast without a column that it needs,
/// and for beams of another size than the frame: the number of columns can change from frame to
/// frame.
void make_point_cloud(const Frame& frame, const Beams& beams, const Scene& scene,
                      const OutputFrame& target_frame, std::span<const std::string> column_names,
                      PointCloud& cloud);

/// The column of this name, or nullptr.
const Column* find_column(const PointCloud& cloud, std::string_view name);

/// Copies the numbers of the points with the indices `kept`, in that order, to another column.
void select_points(const Column& from, std::span<const std::uint32_t> kept, Column& to);

/// Copies the points with a valid xyz to `hits`, as one row, and reuses its memory; `hits` must be
/// another cloud. Throws Error if there is no column xyz.
void remove_invalid_points(const PointCloud& cloud, PointCloud& hits);

}  // namespace glidar
