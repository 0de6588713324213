// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "compute_caster.hpp"

#include "compute_shaders.hpp"
#include "raw_opengl.hpp"

#include <glidar/core/error.hpp>

#include <algorithm>

namespace glidar::bench {
namespace {

/// A pose in the layout of the shader.
struct DeviceView {
  std::array<double, 4> row_x;
  std::array<double, 4> row_y;
  std::array<double, 4> row_z;
  std::array<double, 4> sensor;
};

DeviceView device_view(const InstanceView& view) {
  const Eigen::Matrix3d& m = view.object_from_sensor;
  const Eigen::Vector3d& o = view.sensor_in_object;
  return {.row_x = {m(0, 0), m(0, 1), m(0, 2), 0.0},
          .row_y = {m(1, 0), m(1, 1), m(1, 2), 0.0},
          .row_z = {m(2, 0), m(2, 1), m(2, 2), 0.0},
          .sensor = {o.x(), o.y(), o.z(), view.scale}};
}

constexpr GLuint kViewsAt = 4;  // binding points in the shader
constexpr GLuint kNumbersAt = 5;
constexpr GLuint kRangesAt = 6;
constexpr GLuint kDoubtsAt = 7;

}  // namespace

ComputeCaster::ComputeCaster(const Scene& scene, const Beams& beams, std::size_t views)
    : scene_(scene),
      beams_(beams),
      views_(views),
      thread_pool_(0),
      resolver_(scene),
      search_(resolver_, thread_pool_),
      context_(chosen_device()),
      use_(context_),
      gpu_(std::make_unique<GpuResources>()) {
  compile(gpu_->program, {{GL_COMPUTE_SHADER, caster_shader().c_str()}});
  glUseProgram(gpu_->program.name());
  gpu_->scene.emplace(resolver_, beams, thread_pool_);
  gpu_->scene->bind();
  for (Batch& batch : gpu_->batches) make_room(batch);
  opengl::check_gl("preparing a cast");
}

GLsizeiptr ComputeCaster::doubts_bytes() const {
  constexpr std::size_t kListedPart = 16;  // of all beams; if more are uncertain, all are tested
  return static_cast<GLsizeiptr>((1 + views_ * beams_.size() / kListedPart) *
                                 sizeof(std::uint32_t));
}

void ComputeCaster::make_room(Batch& batch) const {
  const auto places = static_cast<GLsizeiptr>(views_ * beams_.size());
  const auto map = [](Mapped& mapped, GLsizeiptr bytes) {
    constexpr GLbitfield kAccess =
        GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, mapped.buffer.name());
    glBufferStorage(GL_SHADER_STORAGE_BUFFER, bytes, nullptr, kAccess | GL_CLIENT_STORAGE_BIT);
    mapped.data = glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, bytes, kAccess);
    opengl::check_gl("making room for hits");
  };
  map(batch.numbers, places * static_cast<GLsizeiptr>(sizeof(std::uint32_t)));
  map(batch.ranges, places * static_cast<GLsizeiptr>(sizeof(double)));
  map(batch.doubts_copy, doubts_bytes());
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, batch.doubts.name());
  glBufferStorage(GL_SHADER_STORAGE_BUFFER, doubts_bytes(), nullptr, 0);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, batch.views.name());
  glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(views_ * sizeof(DeviceView)),
               nullptr, GL_STREAM_DRAW);
}

void ComputeCaster::upload_views(const Batch& batch) const {
  std::vector<DeviceView> views;
  const Instance& instance = scene_.instances[0];
  for (const Pose& pose : batch.poses) {
    views.push_back(
        device_view(view_of(instance, resolver_.mesh(0), instance.world_from_object, pose)));
  }
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, batch.views.name());
  glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0,
                  static_cast<GLsizeiptr>(views.size() * sizeof(DeviceView)), views.data());
}

void ComputeCaster::start(std::span<const Pose> world_from_sensor) {
  Batch& batch = gpu_->batches[started_++ % kUnderWay];
  batch.poses.assign(world_from_sensor.begin(), world_from_sensor.end());
  upload_views(batch);
  constexpr GLuint kZero = 0;
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, batch.doubts.name());
  glClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, sizeof(kZero), GL_RED_INTEGER,
                       GL_UNSIGNED_INT, &kZero);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kViewsAt, batch.views.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kNumbersAt, batch.numbers.buffer.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kRangesAt, batch.ranges.buffer.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kDoubtsAt, batch.doubts.name());
  glDispatchCompute((beams_.cols + kTileSide - 1) / kTileSide,
                    (beams_.rows + kTileSide - 1) / kTileSide,
                    static_cast<GLuint>(batch.poses.size()));
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
  glBindBuffer(GL_COPY_READ_BUFFER, batch.doubts.name());
  glBindBuffer(GL_COPY_WRITE_BUFFER, batch.doubts_copy.buffer.name());
  glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, doubts_bytes());
  batch.done = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  glFlush();
}

const BatchHits& ComputeCaster::finish() {
  Batch& batch = gpu_->batches[finished_++ % kUnderWay];
  constexpr GLuint64 kLongest_ns = 60'000'000'000;
  const GLenum state = glClientWaitSync(batch.done, GL_SYNC_FLUSH_COMMANDS_BIT, kLongest_ns);
  glDeleteSync(batch.done);
  opengl::check_not_lost();
  opengl::check_gl("casting");
  if (state != GL_ALREADY_SIGNALED && state != GL_CONDITION_SATISFIED) {
    throw Error({.where = "OpenGL",
                 .found = "a batch that is not done after a minute",
                 .remedy = "cast fewer views at once"});
  }
  const std::size_t places = batch.poses.size() * beams_.size();
  batch.hits = {.primitive = {static_cast<std::uint32_t*>(batch.numbers.data), places},
                .range_m = {static_cast<double*>(batch.ranges.data), places},
                .undecided = *static_cast<const std::uint32_t*>(batch.doubts_copy.data)};
  if (batch.hits.undecided > 0) decide(batch);
  return batch.hits;
}

void ComputeCaster::decide(Batch& batch) {
  const auto room = static_cast<std::size_t>(doubts_bytes()) / sizeof(std::uint32_t) - 1;
  const auto* listed = static_cast<const std::uint32_t*>(batch.doubts_copy.data) + 1;
  std::vector<std::uint32_t> places;
  if (batch.hits.undecided <= room) {
    places.assign(listed, listed + batch.hits.undecided);
    std::sort(places.begin(), places.end());
  } else {
    for (std::uint32_t i = 0; i < batch.hits.primitive.size(); ++i) {
      if (batch.hits.primitive[i] == kUndecided) places.push_back(i);
    }
  }
  const auto beams = static_cast<std::uint32_t>(beams_.size());
  for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end) {
    const std::uint32_t view = places[begin] / beams;
    while (end < places.size() && places[end] / beams == view) ++end;
    decide_view(batch, view, std::span(places).subspan(begin, end - begin));
  }
}

void ComputeCaster::decide_view(const Batch& batch, std::size_t view,
                                std::span<const std::uint32_t> places) {
  const CastRequest request{.beams = beams_, .world_from_sensor = batch.poses[view]};
  resolver_.set_poses(request.world_from_sensor, {});
  search_.prepare(request);
  constexpr std::size_t kBeamsPerTask = 64;
  thread_pool_.parallel_for(places.size(), kBeamsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      decide_beam(request, places[i] - view * beams_.size(), batch.hits.primitive[places[i]],
                  batch.hits.range_m[places[i]]);
    }
  });
}

void ComputeCaster::decide_beam(const CastRequest& request, std::size_t beam,
                                std::uint32_t& primitive, double& range_m) const {
  const PrimitiveRef found = search_.beams().find(beam);
  primitive = found.instance == kInvalidId ? kMissed : found.primitive;
  if (found.instance == kInvalidId) return;
  HitBlock block;
  BeamBlock lanes;
  ExactHits exact;
  block.mask = 1;
  block.beam.fill(beam);
  block.instance[0] = found.instance;
  block.primitive[0] = found.primitive;
  for (unsigned i = 0; i < kLanes; ++i) lanes.direction.set(i, request.beams.directions[beam]);
  resolver_.intersect(lanes, block, exact);
  range_m = exact.distance[0] * resolver_.view(0).scale;
}

}  // namespace glidar::bench
