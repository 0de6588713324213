// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/format_table.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/excerpt.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/formats/cloud_picture_file.hpp>
#include <glidar/io/formats/csv_file.hpp>
#include <glidar/io/formats/depth_png_file.hpp>
#include <glidar/io/formats/depth_tiff_file.hpp>
#include <glidar/io/formats/kitti_file.hpp>
#include <glidar/io/formats/kitti_folder.hpp>
#include <glidar/io/formats/npy_file.hpp>
#include <glidar/io/formats/npz_file.hpp>
#include <glidar/io/formats/pcd_file.hpp>
#include <glidar/io/formats/ply_file.hpp>
#include <glidar/io/formats/preview_file.hpp>
#include <glidar/io/formats/transform_file.hpp>
#include <glidar/io/formats/truth_images.hpp>
#include <glidar/io/formats/woods2016_png_file.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>

namespace glidar {
namespace {

/// For formats that do not store points.
std::vector<PointField> no_fields(const PointCloud& /*cloud*/) {
  return {};
}

/// Image formats.
std::vector<Format> image_formats() {
  return {
      {{".depth.tiff", "32-bit depth image, metres", {"depth"}, false},
       Content::image,
       depth_fields,
       write_depth_tiff,
       nullptr,
       "depth in metres as 32-bit float; NaN: no return"},
      {{".rgb.png", "surface colour, lit at the sensor", {"colour", "incidence"}, false},
       Content::image,
       no_fields,
       write_rgb_png,
       nullptr,
       "surface colour times cosine of incidence times 255 as 8-bit RGB; black: no surface"},
      {{".normal.png", "16-bit normals", {"normal"}, false},
       Content::image,
       no_fields,
       write_normal_png,
       nullptr,
       "unit normal n in frame_id as 16-bit RGB v: n = 2 v / 65535 - 1; 0 0 0: no surface"},
      {{".instance.png", "16-bit instance ids", {"instance"}, false},
       Content::image,
       no_fields,
       write_instance_png,
       nullptr,
       "id of the instance as 16-bit grey; 0: no surface"},
      {{".class.png", "class ids", {"class"}, false},
       Content::image,
       no_fields,
       write_class_png,
       nullptr,
       "id of the class as grey; 0: unlabelled, or no surface"},
  };
}

std::vector<Format> with_images(std::vector<Format> formats) {
  for (const Format& format : image_formats()) formats.push_back(format);
  return formats;
}

}  // namespace

const std::vector<Format>& formats() {
  static const std::vector<Format> kFormats = with_images({
      {{".pcd", "Point Cloud Library", {"xyz"}, true}, Content::points, pcd_fields, write_pcd},
      {{".ply", "Stanford polygon file", {"xyz"}, true}, Content::points, ply_fields, write_ply},
      {{".npz", "NumPy archive of all columns", {"xyz"}, true},
       Content::points,
       native_fields,
       write_npz},
      {{".csv", "text table", {"xyz"}, true}, Content::points, native_fields, write_csv},
      {{".bin", "KITTI Velodyne, with .label", {"xyz", "intensity"}, false},
       Content::kitti,
       kitti_fields,
       write_kitti,
       stage_labels_beside},
      {{".kitti", "folder: velodyne calib label_2 labels", {"xyz", "intensity"}, false, true},
       Content::kitti,
       kitti_fields,
       nullptr,
       stage_kitti_folder},
      {{".npy", "NumPy depth image, metres", {"depth"}, false},
       Content::image,
       depth_fields,
       write_depth_npy,
       nullptr,
       "depth in metres as 32-bit float; NaN: no return"},
      {{".depth.png", "16-bit depth image", {"depth"}, false},
       Content::image,
       no_fields,
       write_depth_png,
       nullptr,
       "depth times units_per_m as 16-bit grey; 0: no return"},
      {{".framebuffer.png", "8-bit RGBA image of --quantized-framebuffer", {}, false},
       Content::per_beam,
       no_fields,
       write_woods2016_png},
      {{".png", "preview picture", {"depth", "intensity"}, false},
       Content::per_beam,
       no_fields,
       write_preview},
      {{".transform", "4x4 pose of the first object", {}, false},
       Content::per_beam,
       no_fields,
       write_transform},
      {{".bev.png", "picture of the cloud from above", cloud_picture_columns(), false},
       Content::per_beam,
       no_fields,
       write_bird_eye},
      {{".view.png", "picture of the cloud in perspective", cloud_picture_columns(), false},
       Content::per_beam,
       no_fields,
       write_perspective},
  });
  return kFormats;
}

namespace {

std::vector<std::string> suffixes() {
  std::vector<std::string> all;
  for (const Format& format : formats()) all.push_back(format.info.suffix);
  return all;
}

std::filesystem::path without_separators(const std::filesystem::path& path) {
  return path.has_filename() ? path : path.parent_path();
}

}  // namespace

std::filesystem::path output_path(const std::filesystem::path& path) {
  return find_format(path).info.is_folder ? without_separators(path) : path;
}

const Format& find_format(const std::filesystem::path& given) {
  const std::filesystem::path path = without_separators(given);
  const std::string name = lower_case(path.filename().string());
  const Format* best = nullptr;
  for (const Format& format : formats()) {
    const std::string& suffix = format.info.suffix;
    if (name.size() <= suffix.size() || !name.ends_with(suffix)) continue;
    if (best == nullptr || suffix.size() > best->info.suffix.size()) best = &format;
  }
  if (best != nullptr) return *best;
  const std::string suffix = lower_case(path.extension().string());
  const std::vector<std::string> all = suffixes();
  const std::string nearest = suffix.empty() ? "" : closest_match(suffix, all);
  throw Error({given.string(),
               suffix.empty() ? "the name has no suffix that selects a format"
                              : fmt::format("no format has the suffix {}", excerpt(suffix)),
               fmt::format("{}", fmt::join(all, " ")),
               nearest.empty() ? "" : fmt::format("did you mean {}?", nearest)});
}

std::span<const FileFormat> file_formats() {
  static const std::vector<FileFormat> kTold = [] {
    std::vector<FileFormat> infos;
    for (const Format& format : formats()) infos.push_back(format.info);
    return infos;
  }();
  return kTold;
}

const FileFormat& format_for(const std::filesystem::path& path) {
  return find_format(path).info;
}

}  // namespace glidar
