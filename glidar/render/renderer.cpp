// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/renderer.hpp>

#include <glidar/core/error.hpp>
#include <glidar/render/cpu_base.hpp>
#include <glidar/render/gpu/gpu_renderer.hpp>
#include <glidar/render/grid_window.hpp>
#include <glidar/render/pieces_renderer.hpp>
#include <glidar/render/pinhole_only.hpp>
#include <glidar/render/rays/rays_renderer.hpp>
#include <glidar/render/triangle_ids.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace glidar {

/// Selects the faster renderer for each cast: a raster for pinhole cameras and scanners that see
/// few triangles per beam, rays for all others. The choice follows from the request alone, and so
/// do the results. Each renderer is built when it is first needed.
std::unique_ptr<Renderer> make_auto_renderer(const Scene& scene, const RendererOptions& options);

namespace {

/// The raster processes every triangle in view, a ray only a few: above this many triangles per
/// beam that may hit something, rays are faster (bench/renderers_bench.py: about 10).
constexpr std::uint64_t kMaxPerBeam = 11;

class AutoRenderer final : public Renderer {
 public:
  AutoRenderer(const Scene& scene, unsigned threads)
      : base_(std::make_shared<CpuBase>(scene, threads)) {
    for (const Mesh& mesh : scene.meshes) boxes_.push_back(bounds(mesh));
    std::uint64_t all = 0;
    for (const Instance& instance : scene.instances) {
      all += scene.meshes[instance.mesh].triangles.size();
    }
    can_draw_ = all < kNoTriangleId;
  }

  [[nodiscard]] std::string_view name() const override { return "auto"; }
  [[nodiscard]] ThreadPool& thread_pool() override { return base_->thread_pool; }

  void cast(const CastRequest& request, Hits& hits) override {
    check(request, base_->resolver.scene());
    faster(request).cast(request, hits);
  }

 private:
  Renderer& faster(const CastRequest& request) {
    if (is_for_raster(request)) {
      if (raster_ == nullptr) raster_ = make_raster_renderer(base_);
      return *raster_;
    }
    if (rays_ == nullptr) rays_ = make_rays_renderer(base_);
    return *rays_;
  }

  bool is_for_raster(const CastRequest& request) {
    if (!can_draw_ || rasterizer_limitation(request.beams) != nullptr) return false;
    const std::uint64_t beams = beams_in_view(request);
    return beams == 0 || triangles(request) <= kMaxPerBeam * beams;
  }

  [[nodiscard]] std::uint64_t triangles(const CastRequest& request) const {
    const Scene& scene = base_->resolver.scene();
    std::uint64_t all = 0;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
      if (is_enabled(request, i)) all += scene.meshes[scene.instances[i].mesh].triangles.size();
    }
    return all;
  }

  /// Number of beams that may hit something.
  std::uint64_t beams_in_view(const CastRequest& request) {
    base_->resolver.set_poses(request.world_from_sensor, request.world_from_instance);
    find_plane_points(request.beams, points_);
    const GridWindow window =
        visible_window(base_->resolver, boxes_, request.instance_enabled, points_);
    const std::uint64_t rows = std::min(window.end_row, request.beams.rows) - window.first_row;
    const std::uint64_t cols = std::min(window.end_col, request.beams.cols) - window.first_col;
    return rows * cols;
  }

  std::shared_ptr<CpuBase> base_;
  std::vector<Eigen::AlignedBox3d> boxes_;  ///< per mesh
  bool can_draw_;                           ///< the triangle ids suffice for all triangles
  PlanePoints points_;
  std::unique_ptr<Renderer> raster_;
  std::unique_ptr<Renderer> rays_;
};

}  // namespace

std::unique_ptr<Renderer> make_auto_renderer(const Scene& scene, const RendererOptions& options) {
  return std::make_unique<AutoRenderer>(scene, options.threads);
}

namespace {

using Factory = std::unique_ptr<Renderer> (*)(const Scene&, const RendererOptions&);

struct Kind {
  std::string name;
  Factory make;
};

const std::array<Kind, 4>& kinds() {
  static const std::array<Kind, 4> all = {{{"auto", make_auto_renderer},
                                           {"rays", make_rays_renderer},
                                           {"raster", make_raster_renderer},
                                           {"gpu", make_gpu_renderer}}};
  return all;
}

}  // namespace

bool any_instance_enabled(const CastRequest& request, const Scene& scene) {
  if (request.instance_enabled.empty()) return !scene.instances.empty();
  return std::any_of(request.instance_enabled.begin(), request.instance_enabled.end(),
                     [](std::uint8_t present) { return present != 0; });
}

namespace {

/// Enabled instances must be within range.
void check_poses(const CastRequest& request, const Scene& scene) {
  for (std::size_t i = 0; i < request.world_from_instance.size(); ++i) {
    if (!is_enabled(request, i)) continue;
    if (is_within_reach(request.world_from_instance[i].translation())) continue;
    throw Error({.where = "cast",
                 .found = "instance '" + scene.instances[i].name + "' is out of reach",
                 .allowed = "up to 1e15 m from the world's origin",
                 .remedy = "end its motion earlier, or move the world's origin nearer to it"});
  }
}

}  // namespace

void check(const CastRequest& request, const Scene& scene) {
  const auto require = [](bool holds, const char* found, const char* allowed,
                          const char* remedy = "") {
    if (holds) return;
    throw Error({.where = "cast", .found = found, .allowed = allowed, .remedy = remedy});
  };
  const Beams& beams = request.beams;
  require(beams.directions.size() == std::size_t{beams.rows} * beams.cols,
          "the number of beams differs from rows x cols", "rows x cols directions");
  require(beams.origins_m.empty() || beams.origins_m.size() == beams.size(),
          "a number of origins that differs from the beams", "one origin per beam, or none");
  require(request.world_from_instance.empty() ||
              request.world_from_instance.size() == scene.instances.size(),
          "a number of poses that differs from the instances", "one pose per instance, or none");
  require(
      request.instance_enabled.empty() || request.instance_enabled.size() == scene.instances.size(),
      "enabled flags for another number of instances", "one entry per instance, or none");
  const auto is_in_scene = [&](const InstanceRange& target) {
    return target.begin <= target.end && target.end <= scene.instances.size();
  };
  require(request.targets.empty() || request.targets.size() == beams.size(),
          "a number of targets that differs from the beams", "one target per beam, or none");
  require(std::all_of(request.targets.begin(), request.targets.end(), is_in_scene),
          "a target outside of the scene", "instances of the scene");
  require(request.targets.empty() || !beams.pinhole, "targets for the pixels of a pinhole",
          "targets for beams without such a grid");
  const FootprintLayout& footprints = request.footprints;
  require(footprints.beams > 0 && beams.size() % footprints.beams == 0,
          "footprints that do not divide the beams", "a divisor of the number of beams");
  require(footprints.slope >= 0.0 && footprints.radius_m >= 0.0, "a footprint without a size",
          "a slope and a radius of at least 0");
  require(is_within_reach(request.world_from_sensor.translation()), "the sensor is out of reach",
          "up to 1e15 m from the world's origin", "move the world's origin nearer to it");
  check_poses(request, scene);
}

void check_batch(std::span<const CastRequest> requests, std::span<Hits* const> hits) {
  if (requests.size() == hits.size()) return;
  throw Error({.where = "batch of casts",
               .found = "hits for " + std::to_string(hits.size()) + " of " +
                        std::to_string(requests.size()) + " casts",
               .allowed = "hits for each cast",
               .remedy = ""});
}

void Renderer::cast_batch(std::span<const CastRequest> requests, std::span<Hits* const> hits) {
  check_batch(requests, hits);
  for (std::size_t i = 0; i < requests.size(); ++i) cast(requests[i], *hits[i]);
}

std::string renderer_kind(const std::string& name) {
  return name == "opengl" ? "gpu" : name;
}

const std::vector<std::string>& renderer_kinds() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Kind& kind : kinds()) all.push_back(kind.name);
    return all;
  }();
  return names;
}

std::unique_ptr<Renderer> make_renderer(const Scene& scene, const RendererOptions& options) {
  std::string names;
  const auto found = std::find_if(kinds().begin(), kinds().end(), [&](const Kind& kind) {
    names += (names.empty() ? "" : ", ") + kind.name;
    return kind.name == renderer_kind(options.kind);
  });
  if (found == kinds().end()) {
    const std::string nearest = closest_match(options.kind, renderer_kinds());
    throw Error({.where = "renderer",
                 .found = "'" + options.kind + "' is not known",
                 .allowed = names,
                 .remedy = nearest.empty() ? "" : "did you mean '" + nearest + "'?"});
  }
  const auto make = [&](const Scene& whole) { return found->make(whole, options); };
  return has_pieces(scene) ? make_pieces_renderer(scene, make) : make(scene);
}

}  // namespace glidar
