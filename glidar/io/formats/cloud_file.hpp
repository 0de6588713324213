// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/formats/file_sink.hpp>
#include <glidar/io/formats/point_rows.hpp>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace glidar {

/// What the writer of a format gets: the cloud as it goes into the file (compacted where asked for)
/// with the columns its FileFormat names, each of its right size.
struct CloudFile {
  const PointCloud& cloud;
  const Frame& frame;
  const FileSinkOptions& options;
  const SidecarContext& context;
  std::span<const Field> fields;  ///< what of each point goes into the file; the sidecar tells it
  std::string layout = {};        ///< that the cloud has; empty: columns of its own
  std::string pixels = {};        ///< what the pixels of an image are; empty: it is no image
};

// What each format stores of a cloud. A writer stores exactly these fields, so that whoever reads
// the list knows the file.

/// Real numbers as float, as PCL's point types need it; colour is PCL's packed `rgb`.
std::vector<Field> pcd_fields(const PointCloud& cloud);
/// x y z are float unless that moves a point by more than 0.1 mm, then double; other columns keep
/// their types, but for integers of 64 bits, which are double; normals are nx ny nz, colour is
/// uchar red green blue.
std::vector<Field> ply_fields(const PointCloud& cloud);
/// x y z intensity as float; see kitti_cloud().
std::vector<Field> kitti_fields(const PointCloud& cloud);
/// depth as float.
std::vector<Field> depth_fields(const PointCloud& cloud);

/// Point Cloud Library, format 0.7: https://pcl.readthedocs.io (The PCD file format). The
/// viewpoint is the sensor's pose in the cloud's frame.
void write_pcd(const CloudFile& job, AtomicFile& file);

/// Stanford polygon file, little-endian or ascii, vertices only. An organised cloud says its size
/// as PCL does: `obj_info num_cols`.
void write_ply(const CloudFile& job, AtomicFile& file);

/// NumPy archive, stored: every column as (rows, cols) or (rows, cols, components), poses 4x4
/// (world_from_sensor, world_from_cloud, world_from_instance (k, 4, 4)), stamp_ns, seed.
void write_npz(const CloudFile& job, AtomicFile& file);

/// A line of field names, then a point per line, the shortest digits that read back the same.
void write_csv(const CloudFile& job, AtomicFile& file);

/// KITTI Velodyne: float32 x y z intensity per point, no header, no misses; of a kitti_cloud().
void write_kitti(const CloudFile& job, AtomicFile& file);

/// NumPy array rows x cols of float32 depth in metres, NaN where there is no return.
void write_depth_npy(const CloudFile& job, AtomicFile& file);

/// 16-bit grey image: depth times options.depth_png_units_per_m, rounded, at least 1; 0 = no
/// return. Throws Error when a depth is behind the sensor or above 65535 units.
void write_depth_png(const CloudFile& job, AtomicFile& file);

/// Depth in metres as TIFF of one 32-bit float per pixel, NaN where there is no return.
void write_depth_tiff(const CloudFile& job, AtomicFile& file);

// Pictures of what is truly there, as 8 or 16-bit PNG, 0 where there is nothing. Errors say which
// number does not fit.

/// 8-bit RGB: the surface's colour times the cosine of incidence, as by light at the sensor that
/// does not weaken with the distance.
void write_rgb_png(const CloudFile& job, AtomicFile& file);
/// 16-bit RGB: the triangle's unit normal in the cloud's frame, n = 2 v / 65535 - 1.
void write_normal_png(const CloudFile& job, AtomicFile& file);
/// 16-bit grey: ids of instances.
void write_instance_png(const CloudFile& job, AtomicFile& file);
/// 8-bit grey, of scenes with more than 256 classes 16-bit grey: ids of classes.
void write_class_png(const CloudFile& job, AtomicFile& file);

/// The frame's Woods2016Framebuffer, byte by byte, as 8-bit RGBA; its planes are told in the file's
/// text. Throws Error when the frame was not read from one.
void write_paper_png(const CloudFile& job, AtomicFile& file);

/// A picture for people: coloured depth and grey intensity with their scales.
void write_preview(const CloudFile& job, AtomicFile& file);

/// What write_bird_eye and write_perspective need of a cloud.
std::vector<std::string> cloud_picture_columns();

/// A picture of the cloud straight from above, x to the right and y up, with axes, coloured as
/// options.picture says; the highest point wins. The cloud's axes are turned so that z is up.
/// Throws Error when a camera's cloud is to be coloured by ring.
void write_bird_eye(const CloudFile& job, AtomicFile& file);

/// The same in perspective, with a grid on the ground; the nearest point wins. Also throws Error
/// when the eye is at the target.
void write_perspective(const CloudFile& job, AtomicFile& file);

/// cloud_from_object of the first instance without its scale, 4x4, a row per line, 17 digits.
/// Throws Error when the frame has no instance.
void write_transform(const CloudFile& job, AtomicFile& file);

/// The JSON that stands beside a cloud written to `path`; docs/files.md lists its fields.
std::string sidecar_text(const CloudFile& job, const std::filesystem::path& path);

}  // namespace glidar
