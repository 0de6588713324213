// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "compute_scene.hpp"

#include <glidar/render/opengl/egl_context.hpp>
#include <glidar/render/rays/scene_search.hpp>
#include <glidar/render/renderer.hpp>

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glidar::bench {

/// Hits of the beams of some views, view by view.
struct BatchHits {
  std::span<std::uint32_t> primitive;  ///< kMissed: nothing
  std::span<double> range_m;           ///< of hits; unset elsewhere
  std::size_t undecided;               ///< beams that the host had to re-test
};

/// Casts many views of one sensor in compute shaders (OpenGL 4.3 and 64-bit numbers), bit-identical
/// to
/// `--renderer rays`. A thread per beam traverses the tree of the ray caster; single precision
/// rejects triangles, double accepts a triangle where its bounds prove that the hit rule does so
/// too, and computes its range in the order of Resolver. Uncertain beams (on edges, between
/// coincident surfaces, almost edge-on, at the sensor) are listed, and the host re-tests them by
/// BeamSearch and Resolver.
///
/// Limits: one instance, no alpha masks, no culled faces, beams from the sensor's origin. Meshes
/// whose triangles all coincide with others are cast by the host.
class ComputeCaster {
 public:
  /// Why the device is not supported, or empty. Compares its arithmetic with the processor's.
  static std::string missing();

  /// The scene must outlive the caster.
  ComputeCaster(const Scene& scene, const Beams& beams, std::size_t views);

  /// Batches that may be started before the first is finished.
  static constexpr std::size_t kUnderWay = 3;

  /// Starts a batch; up to as many poses of the sensor as the constructor was given.
  void start(std::span<const Pose> world_from_sensor);

  /// Waits for the batch that was started first and re-tests uncertain beams. The hits are valid
  /// until the next start().
  const BatchHits& finish();

 private:
  /// Memory of the host that the device writes to.
  struct Mapped {
    opengl::Buffer buffer;
    void* data = nullptr;
  };
  struct Batch {
    opengl::Buffer views;
    Mapped numbers;
    Mapped ranges;
    opengl::Buffer doubts;  ///< number and indices
    Mapped doubts_copy;
    GLsync done = nullptr;
    std::vector<Pose> poses;
    BatchHits hits;
  };
  /// Objects on the device.
  struct GpuResources {
    opengl::Program program;
    std::optional<ComputeScene> scene;
    std::array<Batch, kUnderWay> batches;
  };

  void make_room(Batch& batch) const;
  /// Size of the list of uncertain beams.
  [[nodiscard]] GLsizeiptr doubts_bytes() const;
  void upload_views(const Batch& batch) const;
  void decide(Batch& batch);
  void decide_view(const Batch& batch, std::size_t view, std::span<const std::uint32_t> places);
  void decide_beam(const CastRequest& request, std::size_t beam, std::uint32_t& primitive,
                   double& range_m) const;

  const Scene& scene_;
  const Beams& beams_;
  std::size_t views_;
  ThreadPool thread_pool_;
  Resolver resolver_;
  rays::SceneSearch search_;
  opengl::EglContext context_;
  opengl::ScopedContext use_;
  std::unique_ptr<GpuResources> gpu_;
  std::size_t started_ = 0;
  std::size_t finished_ = 0;
};

}  // namespace glidar::bench
