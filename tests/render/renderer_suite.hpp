// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Shared parts of the tests that every renderer must pass.
#include <glidar/core/error.hpp>
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/math/random.hpp>
#include <glidar/render/opengl/egl_context.hpp>
#include <glidar/render/renderer.hpp>
#include <support/brute_force.hpp>
#include <support/data.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace glidar::testing {

/// Random numbers for test rays, always the same.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : draw_{.seed = seed} {}
  double next() {
    if (used_ == 4) {
      ++draw_.block;
      used_ = 0;
    }
    if (used_ == 0) words_ = random_words(draw_);
    return uniform(words_[used_++]);
  }
  Eigen::Vector3d direction() {
    const double z = 2.0 * next() - 1.0;
    const double angle = 2.0 * std::numbers::pi * next();
    const double radius = std::sqrt(1.0 - z * z);
    return Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), z).normalized();
  }

 private:
  RngKey draw_;
  RandomWords words_{};
  unsigned used_ = 0;
};

inline Beams loose_beams(std::vector<Eigen::Vector3d> directions,
                         std::vector<Eigen::Vector3d> origins) {
  Beams beams;
  beams.rows = 1;
  beams.cols = static_cast<std::uint32_t>(directions.size());
  beams.frame_id = "test";
  beams.directions = std::move(directions);
  beams.origins_m = std::move(origins);
  return beams;
}

inline Beams pinhole_beams(const PinholeIntrinsics& k) {
  Beams beams;
  beams.rows = k.height;
  beams.cols = k.width;
  beams.frame_id = "camera_optical_frame";
  for (std::uint32_t v = 0; v < k.height; ++v) {
    for (std::uint32_t u = 0; u < k.width; ++u) {
      beams.directions.push_back(direction_through(plane_x(k, u), plane_y(k, v)));
    }
  }
  beams.pinhole = k;
  return beams;
}

inline Beams camera_beams(std::uint32_t width, std::uint32_t height, double focal_px) {
  return pinhole_beams({.width = width,
                        .height = height,
                        .fx = focal_px,
                        .fy = focal_px,
                        .cx = 0.5 * width,
                        .cy = 0.5 * height});
}

inline Pose turned(double angle, const Eigen::Vector3d& axis, const Eigen::Vector3d& position) {
  return make_pose(position, Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized())));
}

inline Scene builtin_scene(const char* name) {
  return scene_of(make_builtin_model(name));
}

/// Why OpenGL is not available; empty if it is.
inline const std::string& missing_opengl() {
  static const std::string kReason = [] {
    try {
      const opengl::EglContext context({});
      return std::string();
    } catch (const Error& error) {
      return std::string(error.what());
    }
  }();
  return kReason;
}

/// Skips the test on a machine without OpenGL, with the reason.
#define GLIDAR_NEEDS_OPENGL()                                                            \
  if (const std::string missing = ::glidar::testing::missing_opengl(); !missing.empty()) \
  GTEST_SKIP() << missing

/// Why the gpu renderer is not available; empty if it is.
inline const std::string& missing_gpu() {
  static const std::string kReason = [] {
    try {
      make_renderer(Scene(), {.kind = "gpu", .threads = 1});
      return std::string();
    } catch (const Error& error) {
      return std::string(error.what());
    }
  }();
  return kReason;
}

/// Skips the test on a machine where it is not available, with the reason.
#define GLIDAR_NEEDS_GPU()                                                            \
  if (const std::string missing = ::glidar::testing::missing_gpu(); !missing.empty()) \
  GTEST_SKIP() << missing

class RendererSuite : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (GetParam() == "gpu") GLIDAR_NEEDS_GPU();
  }

  static std::unique_ptr<Renderer> renderer(const Scene& scene, unsigned threads = 2) {
    return make_renderer(scene, {.kind = GetParam(), .threads = threads});
  }

  static Hits cast(const Scene& scene, const Beams& beams, const Pose& world_from_sensor,
                   bool cull_back_faces = false) {
    Hits hits;
    renderer(scene)->cast({.beams = beams,
                           .world_from_sensor = world_from_sensor,
                           .world_from_instance = {},
                           .hit_columns = kAllHitColumns,
                           .cull_back_faces = cull_back_faces},
                          hits);
    return hits;
  }
};

/// Tests of renderers that cast beams of any pattern.
class AnyBeamsSuite : public RendererSuite {};

}  // namespace glidar::testing
