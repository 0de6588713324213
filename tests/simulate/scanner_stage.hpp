// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/constants.hpp>
#include <simulate/panels.hpp>
#include <support/simulate.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace glidar::testing {

inline constexpr double kScannerFocal_px = 500.0;
inline constexpr double kProjectorFocal_px = 600.0;
inline constexpr double kScannerBaseline_m = 0.2;

/// A structured-light camera at a pose, whose projector is beside it along x with parallel axes.
/// The projector's image is shifted so that its middle is on the camera's axis at 0.8 m. Without
/// ambient light, and without noise except for the rounding of levels.
struct ScannerStage {
  PanelScene panels;
  Sensor sensor;
  Pose world_from_sensor = Pose::Identity();
  Trajectory motion = ConstantPose{};                ///< of the sensor, relative to its pose
  std::vector<Trajectory> world_from_instance = {};  ///< empty: stationary
  RendererOptions renderer = {.threads = 2};

  explicit ScannerStage(std::uint32_t width = 160, std::uint32_t height = 24) {
    sensor.optics = Pinhole{{.width = width,
                             .height = height,
                             .fx = kScannerFocal_px,
                             .fy = kScannerFocal_px,
                             .cx = 0.5 * width,
                             .cy = 0.5 * height},
                            NoDistortion{}};
    sensor.wavelength_m = 460e-9;
    sensor.depth_model = DepthModel::physical;
    StructuredLightCamera scanner;
    scanner.projector.intrinsics = {.width = 640,
                                    .height = 320,
                                    .fx = kProjectorFocal_px,
                                    .fy = kProjectorFocal_px,
                                    .cx = 470.0,
                                    .cy = 160.0};
    scanner.projector_from_camera.translation() = Eigen::Vector3d(-kScannerBaseline_m, 0.0, 0.0);
    scanner.patterns.width = 640;
    scanner.patterns.height = 320;
    scanner.illumination.ambient_w_per_m2 = 0.0;
    scanner.imager.bits = 16;
    scanner.imager.full_well_e = 1e14;  // shot noise of 1e-7
    scanner.imager.read_noise_e = 0.0;
    scanner.imager.auto_exposure = {.target = 0.4, .max_time_s = 1e9, .max_gain = 1.0};
    scanner.decoding.min_modulation = 100.0;
    scanner.decoding.min_code_difference = 100.0;
    sensor.depth_camera = scanner;
  }

  [[nodiscard]] StructuredLightCamera& camera() {
    return std::get<StructuredLightCamera>(*sensor.depth_camera);
  }

  /// Electrons that a pixel holds, with this read noise.
  void use_noise(double full_well_e, double read_noise_e) {
    camera().imager.full_well_e = full_well_e;
    camera().imager.read_noise_e = read_noise_e;
    camera().imager.auto_exposure.max_time_s = 10.0;  // the automatic one is found to 6e-8 of it
  }

  [[nodiscard]] Frame shoot(std::uint64_t seed = 1) const {
    const auto made = make_renderer(panels.scene, renderer);
    Simulator simulator(panels.scene, sensor, *made);
    Frame frame;
    frame.seed = seed;
    const Trajectory path = std::holds_alternative<ConstantPose>(motion)
                                ? Trajectory(ConstantPose{world_from_sensor})
                                : transformed(world_from_sensor, motion);
    simulator.simulate(make_motion(panels.scene, path, world_from_instance),
                       HitColumnMask{.depth = true}, frame);
    return frame;
  }
};

/// The largest phase error by the rounding of patterns to 8 bits, at full contrast: each level errs
/// by up to 1/255 of the amplitude, and the phase by 2/N sum |sin| of it, which is at most 4/3.
inline constexpr double kMaxRoundingError_rad = 4.0 / 3.0 / 255.0;

/// Depth for a phase error: z^2 / (f b) T / (2 pi) (docs/structured-light.md).
inline double depth_error_m(double z_m, double period_px, double phase_error_rad) {
  return z_m * z_m / (kProjectorFocal_px * kScannerBaseline_m) * period_px / kTwoPi *
         phase_error_rad;
}

/// The coordinate at which the projector of the stage lights a point of the camera's frame.
inline double stage_coordinate_px(const Eigen::Vector3d& point_m) {
  return kProjectorFocal_px * (point_m.x() - kScannerBaseline_m) / point_m.z() + 470.0 - 0.5;
}

/// Whether the blur of a pixel reaches beyond the image, where its last rays are repeated: up to 4
/// standard deviations of 0.5 px.
inline bool is_at_border(const Frame& frame, std::size_t i) {
  constexpr std::size_t kReach_px = 2;
  const std::size_t row = i / frame.cols;
  const std::size_t column = i % frame.cols;
  return std::min(row, frame.rows - 1 - row) < kReach_px ||
         std::min(column, frame.cols - 1 - column) < kReach_px;
}

inline std::size_t count_of(const Frame& frame, Status status) {
  return static_cast<std::size_t>(std::count(frame.status.begin(), frame.status.end(), status));
}

}  // namespace glidar::testing
