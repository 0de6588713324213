// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/kitti_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/io/formats/point_rows.hpp>

#include <fmt/format.h>

#include <array>
#include <limits>

namespace glidar {
namespace {

constexpr std::uint32_t kMaxLabel = std::numeric_limits<std::uint16_t>::max();

/// A 16-bit number of a label; 0 for no surface.
std::uint32_t label_part(std::uint32_t id, const char* what, const AtomicFile& file) {
  if (id == kInvalidId) return 0;
  if (id <= kMaxLabel) return id;
  throw Error({file.path().string(), fmt::format("the {} id {} does not fit 16 bits", what, id),
               "ids up to 65535",
               "set 'id' of the model in the scene file, or write .npz with the columns instance "
               "and class"});
}

const std::vector<std::uint32_t>& ids_of(const CloudFile& job, const char* name,
                                         const AtomicFile& file) {
  const Column* column = find_column(job.cloud, name);
  if (column != nullptr) return std::get<std::vector<std::uint32_t>>(column->values);
  throw Error({file.path().string(), fmt::format("the cloud has no column {}", name),
               "clouds of scenes with classes have the columns instance and class",
               fmt::format("request {} too", name)});
}

}  // namespace

std::vector<PointField> kitti_fields(const PointCloud& cloud) {
  std::vector<PointField> fields;
  append_fields(*find_column(cloud, "xyz"), fields);
  append_fields(*find_column(cloud, "intensity"), fields);
  for (PointField& field : fields) field.stored = Stored::f32;
  return fields;
}

PointCloud kitti_cloud(const PointCloud& cloud, const Sensor& sensor, const Beams& beams) {
  PointCloud result{cloud.rows, cloud.cols, cloud.frame_id, cloud.world_from_cloud, {}};
  for (const char* name : {"xyz", "instance", "class"}) {
    if (const Column* column = find_column(cloud, name)) result.columns.push_back(*column);
  }
  result.columns.push_back({"intensity", {"intensity"}, unit_intensities(cloud, sensor, beams)});
  return result;
}

void write_kitti(const CloudFile& job, AtomicFile& file) {
  write_binary_rows(job.fields, job.cloud.size(), file, job.options.progress);
}

void write_kitti_labels(const CloudFile& job, AtomicFile& file) {
  const auto& ids = ids_of(job, "instance", file);
  const auto& classes = ids_of(job, "class", file);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::uint32_t label =
        label_part(classes[i], "class", file) | label_part(ids[i], "instance", file) << 16U;
    const std::array bytes = {
        static_cast<std::byte>(label & 0xFFU), static_cast<std::byte>(label >> 8U & 0xFFU),
        static_cast<std::byte>(label >> 16U & 0xFFU), static_cast<std::byte>(label >> 24U)};
    file.write(bytes);
  }
}

std::filesystem::path labels_path(const std::filesystem::path& path) {
  return std::filesystem::path(path).replace_extension(".label");
}

void stage_labels_beside(const CloudFile& job, const std::filesystem::path& path,
                         StagedFiles& files) {
  stage_kitti_labels(job, labels_path(path), files);
}

void stage_kitti_labels(const CloudFile& job, const std::filesystem::path& path,
                        StagedFiles& files) {
  if (!has_classes(job.context.scene)) {
    files.remove(path);
    return;
  }
  AtomicFile& labels = files.add(path);
  write_kitti_labels(job, labels);
  labels.finish();
}

Format kitti_format() {
  return {.info = {.suffix = ".bin",
                   .description = "KITTI Velodyne, with .label",
                   .columns = {"xyz", "intensity"},
                   .optional_columns = {"range", "instance", "class"}},
          .content = Content::kitti,
          .fields = kitti_fields,
          .write = write_kitti,
          .stage_extra_files = stage_labels_beside,
          .extra_path = labels_path};
}

}  // namespace glidar
