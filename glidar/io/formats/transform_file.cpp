// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/format.hpp>

#include <glidar/core/error.hpp>

#include <fmt/format.h>

namespace glidar {
namespace {

/// Writes cloud_from_object of the first instance without its scale, 4x4, one row per line, 17
/// digits. Throws Error when the frame has no instance.
void write_transform(const CloudFile& job, AtomicFile& file) {
  if (job.frame.world_from_instance.empty()) {
    throw Error({file.path().string(), "the scene has no object whose pose could be written",
                 "at least one instance"});
  }
  const Pose cloud_from_object =
      job.cloud.world_from_cloud.inverse() * job.frame.world_from_instance.front();
  const Eigen::Matrix4d& matrix = cloud_from_object.matrix();
  for (Eigen::Index row = 0; row < 4; ++row) {
    // + 0.0 converts -0 to 0
    file.write(fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}\n", matrix(row, 0) + 0.0,
                           matrix(row, 1) + 0.0, matrix(row, 2) + 0.0, matrix(row, 3) + 0.0));
  }
}

}  // namespace

Format transform_format() {
  return {.info = {.suffix = ".transform",
                   .description = "4x4 pose of the first object",
                   .columns = {}},
          .content = Content::per_beam,
          .write = write_transform,
          .is_text = [](const FileSinkOptions& /*options*/) { return true; }};
}

}  // namespace glidar
