// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/embree/embree_renderer.hpp>

#include <glidar/render/embree/embree_world.hpp>
#include <glidar/render/embree/settle.hpp>
#include <glidar/render/embree/tiles.hpp>
#include <glidar/render/resolve.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <array>
#include <cmath>
#include <limits>

namespace glidar {
namespace {

using embree::FilterContext;
using embree::Probe;
using embree::Tile;
using embree::TraceSpace;

/// What one cast hands to every tile.
struct Job {
  const Beams& beams;
  const HitFields& fields;
  const Resolver& resolver;
  const Probe probe;
  Hits& hits;
};

/// Rays of a tile in Embree's order of arrays; lanes without a beam are not valid.
template <int kWidth>
struct TileRays {
  alignas(64) std::array<int, kWidth> valid;
  alignas(64) typename embree::Packet<kWidth>::RayHit packet;
};

template <int kWidth>
void fill_rays(const Job& job, const Tile& tile, TileRays<kWidth>& rays) {
  auto& ray = rays.packet.ray;
  for (unsigned lane = 0; lane < kWidth; ++lane) {
    const std::size_t beam = tile.beam(lane);
    rays.valid[lane] = 0;
    if (beam == Tile::kOutside) continue;
    const embree::TraceRay start = job.probe.ray(beam);
    if (std::isnan(start.direction.x())) continue;  // the optics have no beam here
    rays.valid[lane] = -1;
    ray.org_x[lane] = start.origin.x();
    ray.org_y[lane] = start.origin.y();
    ray.org_z[lane] = start.origin.z();
    ray.dir_x[lane] = start.direction.x();
    ray.dir_y[lane] = start.direction.y();
    ray.dir_z[lane] = start.direction.z();
    ray.tnear[lane] = 0.0F;
    ray.tfar[lane] = std::numeric_limits<float>::infinity();
    ray.time[lane] = 0.0F;
    ray.mask[lane] = ~0U;  // packaged Embree is built with ray masks
    ray.id[lane] = static_cast<unsigned>(beam);
    ray.flags[lane] = 0;
    rays.packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    rays.packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
  }
}

/// Casts and writes one tile.
template <int kWidth>
void cast_tile(const Job& job, const Tile& tile) {
  TileRays<kWidth> rays;
  fill_rays(job, tile, rays);
  FilterContext context = job.probe.context();
  context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  embree::Packet<kWidth>::intersect(rays.valid.data(), job.probe.space().scene, &context.embree,
                                    &rays.packet);
  const auto& hit = rays.packet.hit;
  for (unsigned lane = 0; lane < kWidth; ++lane) {
    const std::size_t beam = tile.beam(lane);
    if (beam == Tile::kOutside) continue;
    if (rays.valid[lane] == 0 || hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) {
      Resolver::write_miss(job.fields, beam, job.hits);
      continue;
    }
    embree::Found found = embree::found_in(hit, lane);
    if (job.probe.is_doubtful(beam, found)) found = job.probe.settle(beam, found);
    if (found.instance == kNoHit) {
      Resolver::write_miss(job.fields, beam, job.hits);
    } else {
      job.resolver.write_hit(job.beams, job.fields, beam, found.instance, found.primitive,
                             job.hits);
    }
  }
}

class EmbreeRenderer final : public Renderer {
 public:
  EmbreeRenderer(const Scene& scene, unsigned threads)
      : arena_(threads == 0 ? tbb::task_arena::automatic : static_cast<int>(threads)),
        resolver_(scene),
        world_(arena_.execute([&scene] { return std::make_unique<embree::World>(scene); })) {}

  [[nodiscard]] std::string_view name() const override { return "embree"; }

  void cast(const CastRequest& request, Hits& hits) override {
    resize(hits, request.beams.size(), request.fields);
    arena_.execute([&] {
      if (request.cull_back_faces) world_->filter_everything();
      resolver_.set_poses(request.world_from_sensor, request.world_from_instance);
      world_->place(request.world_from_sensor, request.world_from_instance);
      const Job job{request.beams, request.fields, resolver_,
                    Probe(world_->space(), resolver_, request.beams, request.cull_back_faces),
                    hits};
      if (world_->has_wide_packets()) {
        cast_tiles<16>(job);
      } else {
        cast_tiles<8>(job);
      }
    });
  }

 private:
  template <int kWidth>
  static void cast_tiles(const Job& job) {
    const embree::Tiling tiling(job.beams, kWidth);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tiling.size()),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i < range.end(); ++i) {
                          cast_tile<kWidth>(job, tiling.tile(i));
                        }
                      });
  }

  tbb::task_arena arena_;
  Resolver resolver_;
  std::unique_ptr<embree::World> world_;
};

}  // namespace

std::unique_ptr<Renderer> make_embree_renderer(const Scene& scene, const RendererOptions& options) {
  validate(scene);
  return std::make_unique<EmbreeRenderer>(scene, options.threads);
}

}  // namespace glidar
