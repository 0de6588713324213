// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/gpu/gpu_renderer.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/render/gpu/device_batch.hpp>
#include <glidar/render/opengl/draw_state.hpp>
#include <glidar/render/opengl/egl_context.hpp>
#include <glidar/render/pieces_renderer.hpp>
#include <glidar/render/rays/tile_cast.hpp>

#include <array>
#include <span>
#include <utility>
#include <vector>

namespace glidar {
namespace {

/// Parts of a batch that may be under way: one is cast, one waits, and the hits of one are written.
constexpr std::size_t kUnderWay = 3;
/// Beams of a part, unless a single request has more: they occupy a GPU, and the memory for their
/// hits is small.
constexpr std::size_t kMaxBeams = std::size_t{1} << 22U;

/// Views of a part: OpenGL guarantees so many groups along a dimension.
constexpr std::size_t kMaxViews = 65535;

/// Instances of all views of a part, unless a single request has more.
constexpr std::size_t kMaxInstances = std::size_t{1} << 17U;

/// Consecutive requests that the device casts together, or one that the host casts.
struct Part {
  std::size_t first;
  std::size_t count;
  bool is_of_device;
};

/// True if a hit is no more than triangle, range and depth, which the host need not compute.
bool needs_range_only(const HitColumnMask& c) {
  return !(c.normal || c.shading_normal || c.incidence || c.shading || c.barycentrics || c.colour ||
           c.diffuse || c.reflectance || c.object_point || c.noise_scale);
}

bool are_alike(const CastRequest& a, const CastRequest& b) {
  return &a.beams == &b.beams && a.cull_back_faces == b.cull_back_faces && a.targets.empty() &&
         b.targets.empty() && needs_range_only(a.hit_columns) == needs_range_only(b.hit_columns);
}

// Short loops over plain arrays, so that they become vectors.

/// Copies ids; returns whether the device decided all beams. For undecided beams, `primitive` is
/// kUndecided and `instance` unspecified.
bool copy_ids(const gpu::FoundHits& found, BeamRange run, Hits& hits) {
  const std::uint32_t* const ids = found.ids.data();
  std::uint32_t* const primitive = hits.primitive.data();
  std::uint32_t* const instance = hits.instance.data();
  std::uint32_t undecided = 0;
  if (found.has_instances) {
    for (std::size_t i = run.begin; i < run.end; ++i) {
      primitive[i] = ids[2 * i];
      instance[i] = ids[2 * i + 1];
      undecided |= static_cast<std::uint32_t>(ids[2 * i] == gpu::kUndecided);
    }
  } else {
    for (std::size_t i = run.begin; i < run.end; ++i) {
      primitive[i] = ids[i];
      instance[i] = ids[i] == kInvalidId ? kInvalidId : found.instance;
      undecided |= static_cast<std::uint32_t>(ids[i] == gpu::kUndecided);
    }
  }
  return undecided == 0;
}

/// Copies ranges; the device leaves those of misses unset.
void copy_ranges(const gpu::FoundHits& found, BeamRange run, Hits& hits) {
  const double* const from = found.range_m.data();
  const std::uint32_t* const instance = hits.instance.data();
  double* const range_m = hits.range_m.data();
  for (std::size_t i = run.begin; i < run.end; ++i) {
    range_m[i] = instance[i] == kInvalidId ? kNaN : from[i];
  }
}

/// Takes over what the device found for a request, and casts what it did not decide.
class FoundHitsReader {
 public:
  FoundHitsReader(const CpuBase& base, const CastRequest& request, const gpu::FoundHits& found,
                  Hits& hits)
      : base_(base), request_(request), found_(found), hits_(hits) {}

  void operator()(BeamRange run) const {
    const bool is_decided = copy_ids(found_, run, hits_);
    if (has_ranges()) copy_ranges(found_, run, hits_);
    if (!is_decided) decide(run);
    if (!has_ranges() || !request_.hit_columns.depth) return;
    for (std::size_t i = run.begin; i < run.end; ++i) {
      hits_.depth_m[i] = depth_m(request_.beams, i, hits_.range_m[i]);
    }
  }

 private:
  [[nodiscard]] bool has_ranges() const { return !found_.range_m.empty(); }

  /// Casts the undecided beams.
  void decide(BeamRange run) const {
    HitBatch batch;
    unsigned used = 0;
    for (std::size_t i = run.begin; i < run.end; ++i) {
      if (hits_.primitive[i] != gpu::kUndecided) continue;
      write_misses({}, i, 1, hits_);
      batch.block.beam[used++] = i;
      if (used == kLanes) find(batch, std::exchange(used, 0));
    }
    if (used > 0) find(batch, used);
  }

  /// Casts up to kLanes beams and writes what they hit over misses; unused lanes repeat the first.
  void find(HitBatch& batch, unsigned used) const {
    const Beams& beams = request_.beams;
    HitBlock& block = batch.block;
    block.mask = (1U << used) - 1U;
    batch.beams.has_origins = !beams.origins_m.empty();
    for (unsigned lane = 0; lane < kLanes; ++lane) {
      if (lane >= used) block.beam[lane] = block.beam[0];
      batch.beams.direction.set(lane, beams.directions[block.beam[lane]]);
      if (batch.beams.has_origins)
        batch.beams.origin_m.set(lane, beams.origins_m[block.beam[lane]]);
    }
    base_.search.beams().find(batch.beams, block);
    for_lanes(block.mask, [&](unsigned lane) {
      hits_.instance[block.beam[lane]] = block.instance[lane];
      hits_.primitive[block.beam[lane]] = block.primitive[lane];
    });
    if (has_ranges()) base_.resolver.write_batch(beams, {}, batch, hits_);
  }

  const CpuBase& base_;
  const CastRequest& request_;
  const gpu::FoundHits& found_;
  Hits& hits_;
};

class GpuRenderer final : public Renderer {
 public:
  GpuRenderer(const Scene& scene, const RendererOptions& options,
              std::unique_ptr<opengl::Context> context)
      : base_(scene, options.threads), tiles_(base_), context_(std::move(context)) {
    const opengl::ScopedDrawState state(*context_);
    gpu::check_device();
    gpu_ = std::make_unique<GpuResources>(base_);
  }

  ~GpuRenderer() override {
    const opengl::ScopedDrawState state(*context_);
    gpu_.reset();
  }

  [[nodiscard]] std::string_view name() const override { return "gpu"; }
  [[nodiscard]] ThreadPool& thread_pool() override { return base_.thread_pool; }

  void cast(const CastRequest& request, Hits& hits) override {
    Hits* const one = &hits;
    cast_batch({&request, 1}, {&one, 1});
  }

  /// While the hits of one part are written, the device casts the next ones.
  void cast_batch(std::span<const CastRequest> requests, std::span<Hits* const> hits) override {
    check_batch(requests, hits);
    for (const CastRequest& request : requests) check(request, base_.resolver.scene());
    divide(requests);
    const opengl::ScopedDrawState state(*context_);
    glUseProgram(gpu_->program.name());
    gpu_->scene.bind();
    const std::size_t ahead = std::min(parts_.size(), kUnderWay) - (parts_.empty() ? 0 : 1);
    for (std::size_t step = 0; step < parts_.size() + ahead; ++step) {
      if (step < parts_.size()) start(requests, step);
      if (step >= ahead) finish(requests, step - ahead, hits);
    }
  }

 private:
  /// Objects in the memory of the graphics device.
  struct GpuResources {
    explicit GpuResources(CpuBase& base)
        : program(gpu::make_cast_program(base.resolver.scene())),
          scene(base.resolver, base.thread_pool) {}
    opengl::Program program;
    gpu::DeviceScene scene;
    gpu::DeviceBeams beams;
    std::array<gpu::DeviceBatch, kUnderWay> batches;
  };

  void divide(std::span<const CastRequest> requests) {
    parts_.clear();
    const std::size_t instances = base_.resolver.scene().instances.size();
    for (std::size_t i = 0; i < requests.size(); ++i) {
      const bool joins = !parts_.empty() && are_alike(requests[parts_.back().first], requests[i]) &&
                         parts_.back().count < kMaxViews &&
                         (parts_.back().count + 1) * requests[i].beams.size() <= kMaxBeams &&
                         (parts_.back().count + 1) * instances <= kMaxInstances;
      if (joins) {
        ++parts_.back().count;
      } else {
        parts_.push_back({i, 1, true});
      }
    }
  }

  gpu::DeviceBatch& batch(std::size_t part) { return gpu_->batches[part % kUnderWay]; }

  void start(std::span<const CastRequest> requests, std::size_t index) {
    Part& part = parts_[index];
    gpu::DeviceBatch& started = batch(index);
    started.clear();
    const CastRequest& first = requests[part.first];
    for (const CastRequest& request : requests.subspan(part.first, part.count)) {
      base_.resolver.set_poses(request.world_from_sensor, request.world_from_instance);
      base_.search.prepare(request);
      part.is_of_device = part.is_of_device && request.beams.size() > 0 &&
                          gpu::DeviceBatch::can_cast(request, base_.search.trees());
      if (!part.is_of_device) return;
      started.add(request, gpu_->scene, base_.resolver, base_.search.trees());
    }
    started.start(first, needs_range_only(first.hit_columns), gpu_->beams);
  }

  void finish(std::span<const CastRequest> requests, std::size_t index,
              std::span<Hits* const> hits) {
    const Part& part = parts_[index];
    if (part.is_of_device) batch(index).wait();
    for (std::size_t i = 0; i < part.count; ++i) {
      const CastRequest& request = requests[part.first + i];
      Hits& to = *hits[part.first + i];
      if (!tiles_.prepare(request, to)) continue;
      if (!part.is_of_device) {
        tiles_.cast(request, {}, to);
        continue;
      }
      const gpu::FoundHits found = batch(index).found(i);
      const FoundHitsReader reader(base_, request, found, to);
      tiles_.cast(request,
                  {.find = FunctionRef<void(BeamRange)>(reader),
                   .finds_all = needs_range_only(request.hit_columns)},
                  to);
    }
  }

  CpuBase base_;
  rays::TileCast tiles_;
  std::unique_ptr<opengl::Context> context_;
  std::unique_ptr<GpuResources> gpu_;
  std::vector<Part> parts_;  ///< of the current cast_batch()
};

}  // namespace

std::unique_ptr<Renderer> make_gpu_renderer(const Scene& scene, const RendererOptions& options) {
  validate(scene);
  return make_gpu_renderer(scene, options,
                           std::make_unique<opengl::EglContext>(options.graphics_device));
}

std::unique_ptr<Renderer> make_gpu_renderer(const Scene& scene, const RendererOptions& options,
                                            std::unique_ptr<opengl::Context> context) {
  validate(scene);
  const auto make = [&](const Scene& whole) -> std::unique_ptr<Renderer> {
    return std::make_unique<GpuRenderer>(whole, options, std::move(context));
  };
  return has_pieces(scene) ? make_pieces_renderer(scene, make) : make(scene);
}

}  // namespace glidar
