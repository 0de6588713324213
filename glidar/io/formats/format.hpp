// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: everything that distinguishes one file format from others.

#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/formats/cloud_file.hpp>
#include <glidar/math/constants.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace glidar {

/// Whether misses are stored, and whether the file has a sidecar.
enum class Content : std::uint8_t {
  points,    ///< a cloud: organised, or without misses by option
  hits,      ///< a cloud: always without misses
  kitti,     ///< the same with KITTI's intensity
  image,     ///< always the whole frame, with a sidecar
  per_beam,  ///< a preview or a pose: always the whole frame, no sidecar
};

/// The column with the number of its frame that points of a file of several frames have.
inline constexpr const char* kFrameColumn = "frame";

/// What the start of a file of several frames has of all of them.
struct RunTotals {
  static constexpr std::size_t kMaxReturns = 15;

  std::uint64_t points = 0;
  // of LAS files:
  std::array<std::uint64_t, kMaxReturns> of_return = {};
  Eigen::Vector3d min_m = Eigen::Vector3d::Constant(kInfinity);
  Eigen::Vector3d max_m = Eigen::Vector3d::Constant(-kInfinity);
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();
  double scale_m = 0.0;
};

/// The size of a cloud in a header, and spaces that make headers of all sizes equally long.
struct CloudSize {
  std::uint64_t rows = 1;
  std::uint64_t cols = 0;
  std::string padding;
};

/// The size of a header that has it `times` times.
CloudSize size_of_run(const RunTotals& totals, std::size_t times);

struct Format {
  FileFormat info;
  Content content = Content::points;
  /// Stored numbers of each point; nullptr: the format stores no points.
  std::vector<PointField> (*fields)(const PointCloud&) = nullptr;
  /// nullptr: `stage_extra_files` writes all.
  void (*write)(const CloudFile&, AtomicFile&) = nullptr;
  /// For one file of all frames of a run: its start, whose length is the same for any totals, and
  /// the points of a frame after it, which are added to the totals; nullptr: a file for each frame.
  std::string (*run_start)(const CloudFile&, const RunTotals&) = nullptr;
  void (*append)(const CloudFile&, RunTotals&, AtomicFile&) = nullptr;
  /// Adds further files; nullptr: none.
  void (*stage_extra_files)(const CloudFile&, const std::filesystem::path&, StagedFiles&) = nullptr;
  /// The path of the further file beside a path; nullptr: none, or a folder of files.
  std::filesystem::path (*extra_path)(const std::filesystem::path&) = nullptr;
  const char* pixels = "";  ///< meaning of an image's pixels, for its sidecar
  /// Whether the file is plain text with these options; nullptr: never.
  bool (*is_text)(const FileSinkOptions&) = nullptr;
  /// The warning for points that the format moves by rounding, empty if there is none; nullptr:
  /// that of rounding_warning().
  std::string (*rounding_warning)(const PointCloud&) = nullptr;
  /// See find_misfit(); nullptr: the format fits all sensors.
  Misfit (*misfit)(const CloudPictureOptions&, const Sensor&, const Beams&) = nullptr;
};

/// Whether files of the format have a sidecar, unless the options forbid it.
inline bool has_sidecar(const Format& format) {
  return format.content != Content::per_beam && !format.info.is_folder;
}

// The formats, each in a file of its own. LAS 1.4: ASPRS, LAS Specification 1.4 R15.

Format pcd_format();
Format ply_format();
Format npz_format();
Format csv_format();            ///< a line of field names, then a line per point
Format las_format();            ///< point record format 6, without misses
Format kitti_format();          ///< see kitti_cloud()
Format kitti_folder_format();   ///< frames that are written one by one, see stage_kitti_scan()
Format npy_format();            ///< depth, of LiDARs range, in metres
Format depth_npy_format();      ///< depth in metres, for every sensor
Format range_npy_format();      ///< range in metres, for every sensor
Format depth_png_format();      ///< 16-bit
Format range_png_format();      ///< 16-bit
Format depth_tiff_format();     ///< 32-bit floats
Format woods2016_png_format();  ///< the quantized framebuffer
Format preview_format();        ///< depth and intensity in colours
Format transform_format();      ///< the pose of the first object as text
Format bird_eye_format();       ///< picture of a cloud from above
Format perspective_format();    ///< picture of a cloud in perspective
Format rgb_png_format();        ///< ground truth; like the next three 0 where beams hit nothing
Format normal_png_format();     ///< ground truth, 16-bit
Format instance_png_format();   ///< ground truth, 16-bit
Format class_png_format();      ///< ground truth, 8-bit or 16-bit
/// OpenEXR image with a channel for each number of a pixel: depth as Z, and all columns of the
/// cloud as 32-bit float or unsigned integer. Columns of 64-bit integers are omitted, as the
/// format has no type for them.
Format exr_format();
Format ir_left_png_format();       ///< Frame::raw_images "ir_left"
Format ir_right_png_format();      ///< Frame::raw_images "ir_right"
Format ir_reference_png_format();  ///< Frame::raw_images "ir_reference"
Format ir_png_format();            ///< Frame::tof_amplitude, rounded
Format tof_npy_format();  ///< Frame::tof_images: frequencies x phase steps x rows x columns
/// Frame::raw_images "pattern_00" ... as uint8 or uint16: images x rows x columns.
Format patterns_npy_format();

/// All of them, in the order in which they are listed to users.
const std::vector<Format>& formats();

/// The format with the longest suffix that matches the name; trailing separators of the path are
/// ignored. Throws Error naming all formats and the nearest one.
const Format& find_format(const std::filesystem::path& given);

}  // namespace glidar
