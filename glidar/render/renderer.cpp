// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/renderer.hpp>

#include <glidar/core/error.hpp>
#include <glidar/render/auto_renderer.hpp>
#include <glidar/render/gpu/gpu_renderer.hpp>
#include <glidar/render/pieces_renderer.hpp>
#include <glidar/render/raster/raster_renderer.hpp>
#include <glidar/render/rays/rays_renderer.hpp>

#include <algorithm>
#include <array>

namespace glidar {
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
