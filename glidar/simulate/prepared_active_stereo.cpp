// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/prepared_active_stereo.hpp>

#include <glidar/sensor/depth_camera/point_spread.hpp>
#include <glidar/sensor/optics/sub_pixels.hpp>

namespace glidar {
namespace {

/// The pattern as a camera at the position of the projector sees it, W/sr.
std::vector<float> view_pattern(const PreparedActiveStereo& prepared) {
  std::vector<float> rays;
  rays.reserve(prepared.rays.size());
  for (const Eigen::Vector3d& ray : prepared.rays.directions) {
    rays.push_back(
        static_cast<float>(intensity_at(prepared.pattern, ray.x() / ray.z(), ray.y() / ray.z())));
  }
  std::vector<float> view;
  ThreadPool one_thread(1);
  average_rays(rays, prepared.camera.sub_rays, prepared.weights,
               {prepared.intrinsics.width, prepared.intrinsics.height}, one_thread, view);
  return view;
}

}  // namespace

PreparedActiveStereo prepare_active_stereo(const ActiveStereo& camera,
                                           const PinholeIntrinsics& intrinsics,
                                           double wavelength_m) {
  PreparedActiveStereo prepared{
      .camera = camera,
      .intrinsics = intrinsics,
      .wavelength_m = wavelength_m,
      .pattern = make_intensity_map(camera.projector),
      .rays = make_beams(divide_pixels({intrinsics, NoDistortion{}}, camera.sub_rays)),
      .weights = point_spread_weights(camera.sub_rays, camera.imager.blur_px),
      .electron_rate = electron_rate_per_radiance(camera.imager, intrinsics.fx, wavelength_m),
      .pattern_view = {}};
  if (camera.reference == ActiveStereo::Reference::pattern) {
    prepared.pattern_view = view_pattern(prepared);
  }
  return prepared;
}

}  // namespace glidar
