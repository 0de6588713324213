// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "raw_opengl.hpp"

#include <glidar/math/random.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/sensor/sensor.hpp>

#include <memory>
#include <vector>

namespace glidar::bench {

constexpr unsigned kThreads = 2;

inline RendererOptions options(const char* kind) {
  return {.kind = kind, .threads = kThreads, .graphics_device = chosen_device()};
}

/// Random sides of a model, from the distance of its own position.
inline std::vector<Pose> poses_around(const Model& model, std::uint64_t seed, std::size_t count) {
  const Eigen::Vector3d middle = bounds(model.scene).center();
  const double distance_m = (model.world_from_sensor.translation() - middle).norm();
  std::vector<Pose> poses;
  for (std::uint32_t i = 0; i < count; ++i) {
    const RandomWords words = random_words({.seed = seed, .block = i});
    const Eigen::Vector3d side(uniform(words[0]) - 0.5, uniform(words[1]) - 0.5,
                               uniform(words[2]) - 0.5);
    poses.push_back(
        look_at(middle + distance_m * side.normalized(), middle, Eigen::Vector3d::UnitY()));
  }
  return poses;
}

/// Frames from many sides of a model, each with normals, as a Monte Carlo run takes them.
class ManyViews {
 public:
  static constexpr std::size_t kViews = 64;

  ManyViews(const Model& model, const char* kind, std::uint32_t side)
      : renderer_(make_renderer(model.scene, options(kind))),
        beams_(make_beams(pinhole_from_fov(side, side, kFov_rad))),
        hits_(kViews) {
    for (const Pose& pose : poses_around(model, 1, kViews)) {
      requests_.push_back(
          {.beams = beams_, .world_from_sensor = pose, .hit_columns = {.normal = true}});
    }
    for (Hits& hits : hits_) all_.push_back(&hits);
  }

  void one_by_one() {
    for (std::size_t i = 0; i < requests_.size(); ++i) renderer_->cast(requests_[i], hits_[i]);
  }
  void together() { renderer_->cast_batch(requests_, all_); }

 private:
  std::unique_ptr<Renderer> renderer_;
  Beams beams_;
  std::vector<CastRequest> requests_;
  std::vector<Hits> hits_;
  std::vector<Hits*> all_;
};

}  // namespace glidar::bench
