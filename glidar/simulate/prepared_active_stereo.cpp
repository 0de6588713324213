// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/prepared_active_stereo.hpp>

namespace glidar {
namespace {

/// The pattern as a camera at the position of the projector sees it, W/sr.
std::vector<float> view_pattern(const PreparedActiveStereo& prepared) {
  const PreparedImager& imager = prepared.imager;
  std::vector<float> rays;
  rays.reserve(imager.rays.size());
  for (const Eigen::Vector3d& ray : imager.rays.directions) {
    rays.push_back(
        static_cast<float>(intensity_at(prepared.pattern, ray.x() / ray.z(), ray.y() / ray.z())));
  }
  std::vector<float> view;
  ThreadPool one_thread(1);
  average_rays(rays, imager.setup.sub_rays, imager.weights, imager.size, one_thread, view);
  return view;
}

}  // namespace

PreparedActiveStereo prepare_active_stereo(const ActiveStereo& camera, const Sensor& sensor) {
  PreparedActiveStereo prepared{
      .camera = camera,
      .imager = prepare_imager(sensor, {camera.imager, camera.illumination, camera.sub_rays}),
      .focal_length_px = std::get<Pinhole>(sensor.optics).intrinsics.fx,
      .pattern = make_intensity_map(camera.projector),
      .pattern_view = {}};
  if (camera.reference == ActiveStereo::Reference::pattern) {
    prepared.pattern_view = view_pattern(prepared);
  }
  return prepared;
}

}  // namespace glidar
