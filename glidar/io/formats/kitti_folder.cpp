// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/kitti_folder.hpp>

#include <glidar/core/frame.hpp>
#include <glidar/io/formats/kitti_file.hpp>
#include <glidar/io/formats/kitti_labels.hpp>

#include <fmt/format.h>

#include <string>

namespace glidar {
namespace {

/// The points in the sensor's frame, which is used as KITTI's Velodyne frame.
PointCloud in_sensor_frame(const CloudFile& job) {
  PointCloud cloud = job.cloud;
  const Pose& world_from_sensor = job.frame.world_from_sensor;
  if (cloud.world_from_cloud.matrix() == world_from_sensor.matrix()) return cloud;
  const Pose sensor_from_cloud = world_from_sensor.inverse() * cloud.world_from_cloud;
  auto& xyz = std::get<std::vector<double>>(cloud.columns.front().values);
  for (std::size_t i = 0; i < xyz.size(); i += 3) {
    Eigen::Map<Eigen::Vector3d> point(&xyz[i]);
    point = (sensor_from_cloud * point).eval();
  }
  return cloud;
}

void stage_frame(const CloudFile& job, const std::filesystem::path& folder, StagedFiles& files) {
  const PointCloud cloud = in_sensor_frame(job);
  const std::vector<PointField> fields = kitti_fields(cloud);
  const CloudFile velodyne{cloud, job.frame, job.options, job.context, fields};
  const KittiCamera camera = kitti_camera(job.context.sensor);
  stage_kitti_scan({velodyne, job.frame.number, {&camera, 1}}, folder, files);
}

}  // namespace

std::string kitti_number(std::uint32_t number) {
  return fmt::format("{:06}", number);
}

void stage_text(const std::filesystem::path& path, const std::string& text, StagedFiles& files) {
  AtomicFile& file = files.add(path);
  file.write(text);
  file.finish();
}

void stage_kitti_scan(const KittiScan& scan, const std::filesystem::path& folder,
                      StagedFiles& files) {
  const Scene& scene = scan.velodyne.context.scene;
  const std::string number = kitti_number(scan.number);
  files.add_folder(folder);
  for (const char* part : {"velodyne", "calib", "label_2"}) files.add_folder(folder / part);
  if (has_classes(scene)) files.add_folder(folder / "labels");
  AtomicFile& points = files.add(folder / "velodyne" / (number + ".bin"));
  write_kitti(scan.velodyne, points);
  points.finish();
  stage_kitti_labels(scan.velodyne, folder / "labels" / (number + ".label"), files);
  stage_text(folder / "calib" / (number + ".txt"),
             kitti_calibration(scan.cameras, KittiCalibration::frame), files);
  stage_text(folder / "label_2" / (number + ".txt"),
             kitti_labels(scene, scan.cameras[0], scan.velodyne.frame), files);
}

Format kitti_folder_format() {
  return {.info = {.suffix = ".kitti",
                   .description = "KITTI folder: scans, boxes, labels, images",
                   .columns = {"xyz", "intensity"},
                   .is_folder = true,
                   .optional_columns = {"range", "instance", "class"},
                   .reads_boxes = true},
          .content = Content::kitti,
          .fields = kitti_fields,
          .stage_extra_files = stage_frame};
}

}  // namespace glidar
