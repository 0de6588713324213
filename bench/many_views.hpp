// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "raw_opengl.hpp"

#include <glidar/core/random.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/sensor/sensor.hpp>

#include <memory>
#include <vector>

namespace glidar::bench {

constexpr unsigned kThreads = 2;

inline RendererOptions options(const char* kind) {
  return {.kind = kind, .threads = kThreads, .graphics_device = chosen_device()};
}

/// Frames from many sides of a model, each with normals, as a Monte Carlo run takes them.
class ManyViews {
 public:
  static constexpr std::size_t kViews = 64;

  ManyViews(const Model& model, const char* kind, std::uint32_t side)
      : renderer_(make_renderer(model.scene, options(kind))),
        beams_(make_beams(pinhole_from_fov(side, side, kFov_rad))),
        hits_(kViews) {
    const Eigen::Vector3d middle = bounds(model.scene).center();
    const double distance_m = (model.world_from_sensor.translation() - middle).norm();
    for (std::uint32_t i = 0; i < kViews; ++i) {
      const RandomWords words = random_words({.seed = 1, .block = i});
      const Eigen::Vector3d side_of(uniform(words[0]) - 0.5, uniform(words[1]) - 0.5,
                                    uniform(words[2]) - 0.5);
      requests_.push_back({.beams = beams_,
                           .world_from_sensor = look_at(middle + distance_m * side_of.normalized(),
                                                        middle, Eigen::Vector3d::UnitY()),
                           .fields = {.normal = true}});
      all_.push_back(&hits_[i]);
    }
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
