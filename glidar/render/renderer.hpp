// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/core/function_ref.hpp>
#include <glidar/core/hits.hpp>
#include <glidar/core/report.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/math/thread_pool.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// One cast: beams from a pose into the scene as it stands.
struct CastRequest {
  const Beams& beams;
  Pose world_from_sensor = Pose::Identity();
  /// One per instance; empty: where the scene puts them.
  std::span<const Pose> world_from_instance = {};
  HitFieldMask fields = {};
  bool cull_back_faces = false;
  /// One per instance, 0: it is not there for this cast; empty: all are.
  std::span<const std::uint8_t> instance_enabled = {};
  /// Called for every beam once, in runs, when the beams' hits are known, by the thread that found
  /// them and so while they are near in memory. Empty: not called.
  FunctionRef<void(BeamRange)> on_tile_done = {};
  ProgressCallback progress = {};  ///< told while the beams are cast
};

/// True when the instance is there for this cast.
inline bool is_enabled(const CastRequest& request, std::size_t instance) {
  return request.instance_enabled.empty() || request.instance_enabled[instance] != 0;
}

/// True when some instance is there.
bool any_instance_enabled(const CastRequest& request, const Scene& scene);

/// Throws Error unless there is a beam for every row and column, a pose for every instance (or
/// none), and the sensor stands within reach.
void check(const CastRequest& request, const Scene& scene);

/// Throws Error unless there are hits for every request.
void check_batch(std::span<const CastRequest> requests, std::span<Hits* const> hits);

/// Finds what beams hit first. Several implementations, chosen at run time.
class Renderer {
 public:
  Renderer() = default;
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;
  virtual ~Renderer() = default;

  [[nodiscard]] virtual std::string_view name() const = 0;

  /// The threads it runs on; for other work on the same frame.
  virtual ThreadPool& thread_pool() = 0;

  /// Fills `hits`. The result does not depend on the number of threads. A second cast of the same
  /// size allocates nothing.
  virtual void cast(const CastRequest& request, Hits& hits) = 0;

  /// Fills *hits[i] with what cast() tells of requests[i], to the bit; one per request. What draws
  /// does many small ones together and overlaps drawing, reading and the rest, so that they take
  /// less time than one by one. Here: one by one.
  virtual void cast_batch(std::span<const CastRequest> requests, std::span<Hits* const> hits);
};

struct RendererOptions {
  std::string kind = "auto";  ///< one of renderer_kinds()
  unsigned threads = 0;       ///< 0: all processors
  /// Which of the machine's graphics devices draws; empty: the first that can.
  std::optional<std::uint32_t> graphics_device = {};
};

/// The kinds there are.
const std::vector<std::string>& renderer_kinds();

/// Builds a renderer over a valid scene, which must outlive it. Moving instances is done per cast;
/// meshes are not rebuilt. Throws Error on an unknown kind, naming those there are.
std::unique_ptr<Renderer> make_renderer(const Scene& scene, const RendererOptions& options);

}  // namespace glidar
