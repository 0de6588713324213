// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/beam_search.hpp>
#include <glidar/render/rays/kernels.hpp>
#include <glidar/render/rays/scene_trees.hpp>

#include <optional>

namespace glidar::rays {

/// Finds hits of beams, cast after cast. Renderers over the same scene may share it.
class SceneSearch {
 public:
  /// Builds the trees of the meshes. Both must outlive the search.
  SceneSearch(const Resolver& resolver, ThreadPool& thread_pool)
      : resolver_(resolver), thread_pool_(thread_pool), trees_(resolver, thread_pool) {}

  /// Prepares the next cast, whose request must outlive its queries; the resolver has its poses.
  void prepare(const CastRequest& request);

  /// The search of the cast that was prepared last.
  [[nodiscard]] const BeamSearch& beams() const { return *beams_; }
  [[nodiscard]] const SceneTrees& trees() const { return trees_; }

 private:
  const Resolver& resolver_;
  ThreadPool& thread_pool_;
  const Kernel& kernel_ = select_kernel();
  SceneTrees trees_;
  std::optional<BeamSearch> beams_;
};

}  // namespace glidar::rays
