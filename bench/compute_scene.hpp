// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/math/thread_pool.hpp>
#include <glidar/render/opengl/gl_object.hpp>
#include <glidar/render/resolver.hpp>

#include <array>

namespace glidar::bench {

/// Inputs of the casting shader for a scene with one instance, in the memory of the graphics
/// device: the ray caster's tree over its triangles, their planes and the beams.
class ComputeScene {
 public:
  /// Requires a current context. Throws Error for an unsupported scene.
  ComputeScene(const Resolver& resolver, const Beams& beams, ThreadPool& thread_pool);

  /// Binds the buffers, and sets the uniforms of the current program.
  void bind() const;

 private:
  std::array<opengl::Buffer, 4> buffers_;  ///< nodes, triangles, planes, directions
  std::array<GLuint, 2> size_;
  std::array<double, 4> sphere_;
  std::array<float, 2> reach_;
};

}  // namespace glidar::bench
