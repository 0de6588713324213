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

/// The instances begin, begin + 1, ..., end - 1.
struct InstanceRange {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;

  bool operator==(const InstanceRange&) const = default;
};

/// Beams that run close together: each footprint has so many consecutive ones.
struct FootprintLayout {
  std::uint32_t beams = 1;  ///< a divisor of their number
  /// Upper bounds of the distances of their directions, and of their origins, from those of the
  /// footprint's first beam.
  double slope = 0.0;
  double radius_m = 0.0;
};

/// Which columns are needed of the hits of a footprint besides its first one; ids always are.
enum class OtherHits : std::uint8_t { all_columns, diffuse, ids };

/// One cast: beams from a pose into the scene.
struct CastRequest {
  const Beams& beams;
  Pose world_from_sensor = Pose::Identity();
  /// One per instance; empty: the scene's own poses.
  std::span<const Pose> world_from_instance = {};
  HitColumnMask hit_columns = {};
  bool cull_back_faces = false;
  /// One per instance; 0: not part of this cast; empty: all are.
  std::span<const std::uint8_t> instance_enabled = {};
  /// One per beam: all that it may hit, enabled or not; empty: every enabled instance. Fastest if
  /// beams with equal targets follow each other.
  std::span<const InstanceRange> targets = {};
  /// Set if all beams are sub-rays of footprints: a renderer may then search those of each at once.
  /// The hits do not depend on it.
  FootprintLayout footprints = {};
  /// Called for a run of footprints, by their beams, when the ids of all hits and all columns of
  /// each footprint's first are known, by the thread that found them: sets what is needed of the
  /// other hits, one per footprint. A renderer may leave what is not needed unspecified. Empty: all
  /// columns of all hits are needed.
  FunctionRef<void(BeamRange, std::span<OtherHits>)> needed_of_others = {};
  /// Called in runs, once for every beam, when its hits are known, by the thread that found them,
  /// so that they are still in its cache. Empty: not called.
  FunctionRef<void(BeamRange)> on_tile_done = {};
  ProgressCallback progress = {};  ///< called while the beams are cast
};

/// True when the instance is part of this cast.
inline bool is_enabled(const CastRequest& request, std::size_t instance) {
  return request.instance_enabled.empty() || request.instance_enabled[instance] != 0;
}

/// True when some instance is part of this cast.
bool any_instance_enabled(const CastRequest& request, const Scene& scene);

/// Throws Error unless there is a beam for every row and column, a pose for every instance (or
/// none), and all positions are within kMaxCoordinate_m.
void check(const CastRequest& request, const Scene& scene);

/// Throws Error unless there are hits for every request.
void check_batch(std::span<const CastRequest> requests, std::span<Hits* const> hits);

/// Finds the first hit of each beam. The implementation is selected at run time.
class Renderer {
 public:
  Renderer() = default;
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;
  virtual ~Renderer() = default;

  [[nodiscard]] virtual std::string_view name() const = 0;

  /// The renderer's threads, also for other work on the same frame.
  virtual ThreadPool& thread_pool() = 0;

  /// Fills `hits`. The result does not depend on the number of threads. A second cast of the same
  /// size allocates nothing.
  virtual void cast(const CastRequest& request, Hits& hits) = 0;

  /// Casts a batch: *hits[i] becomes bit-identical to cast(requests[i]). The default implementation
  /// loops; a GPU casts small requests together, while the hits of those before are written.
  virtual void cast_batch(std::span<const CastRequest> requests, std::span<Hits* const> hits);
};

struct RendererOptions {
  std::string kind = "auto";  ///< one of renderer_kinds(), or another name of one
  unsigned threads = 0;       ///< 0: all processors
  /// Index of the graphics device; empty: the first that has a context.
  std::optional<std::uint32_t> graphics_device = {};
};

/// Names of all renderers.
const std::vector<std::string>& renderer_kinds();

/// The kind of this name: "opengl" is another name of "gpu".
std::string renderer_kind(const std::string& name);

/// Builds a renderer over a valid scene, which must outlive it. Poses may change with every cast.
/// Throws Error for an unknown kind and lists the valid ones.
std::unique_ptr<Renderer> make_renderer(const Scene& scene, const RendererOptions& options);

}  // namespace glidar
