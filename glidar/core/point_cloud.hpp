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

/// One named quantity of every point: `components.size()` numbers a point, point by point.
struct Column {
  std::string name;                     ///< e.g. "normal"
  std::vector<std::string> components;  ///< field names, e.g. normal_x normal_y normal_z
  std::variant<std::vector<float>, std::vector<double>, std::vector<std::uint8_t>,
               std::vector<std::uint16_t>, std::vector<std::uint32_t>, std::vector<std::int64_t>>
      values;
};

/// Columns of a frame in a named coordinate frame. Organised (rows x cols, a miss has NaN
/// coordinates) unless compacted, which leaves one row.
struct PointCloud {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::string frame_id;
  Pose world_from_cloud = Pose::Identity();  ///< pose of frame_id
  std::vector<Column> columns;

  [[nodiscard]] std::size_t size() const { return std::size_t{rows} * cols; }
};

/// Names make_point_cloud knows, in the order files list them:
/// xyz true_xyz intensity range true_range sigma depth normal shading_normal incidence instance
/// class primitive barycentrics colour object_point status row col ring time return return_source
/// azimuth elevation stamp sensor_pose object_pose
std::span<const std::string> cloud_column_names();

/// The optional hit columns that these cloud columns need. Throws Error on an unknown name.
HitFieldMask fields_needed_by(std::span<const std::string> column_names);

/// Fills `cloud` with the named columns of a frame, reusing its memory.
///  xyz           f64 x3, metres in `cloud_frame`, from the measured range; NaN unless a hit
///  true_xyz      f64 x3, the same of what is truly there, whether reported or not, as fired from
///                where the sensor was
///  intensity     f32
///  range, depth  f64, metres, measured; NaN unless a hit. Ranges count from where the sensor's do
///                (Beams::range_offset_m); coordinates do not care
///  true_range    f64, metres, of what is there, counted likewise; NaN for a miss
///  sigma         f32, metres, standard deviation of the range's random error
///  normal, shading_normal  f32 x3, unit, in `cloud_frame`
///  incidence     f32, radians
///  instance, class  u32, the instance's id and class_id; kInvalidId where there is none
///  primitive     u32, triangle of the mesh; kInvalidId where there is none
///  barycentrics  f32 x2; colour f32 x3; object_point f64 x3 in the object's own frame
///  status        u8, see Status; row, col u32
///  ring          u16, channel number; time u32, ns since the frame's start
///  return        u8, from 0: which of the sensor's returns; return_source u8, see ReturnSource
///  azimuth, elevation  f64, radians, where the beam was aimed in the sensor's frame: to the left
///  of
///                the boresight (-pi to pi), and up; of LiDARs that is from +x towards +y, and
///                towards +z
///  stamp         i64, ns, when the beam left: the frame's stamp_ns and `time`
///  sensor_pose   f64 x7, world_from_sensor when the beam left: metres, quaternion w x y z
///  object_pose   f64 x7, likewise world_from_object, without scale, of the instance that was hit;
///                NaN where there is none
/// Throws Error when a column is unknown or the frame was cast without what it needs.
void make_point_cloud(const Frame& frame, const Beams& beams, const Scene& scene,
                      const OutputFrame& cloud_frame, std::span<const std::string> column_names,
                      PointCloud& cloud);

/// The column of this name, or nullptr.
const Column* find_column(const PointCloud& cloud, std::string_view name);

/// The points whose x is a number, as one row (needs the column xyz); the memory of `hits`, another
/// cloud, is reused. Throws Error when there are no coordinates.
void remove_invalid_points(const PointCloud& cloud, PointCloud& hits);

}  // namespace glidar
