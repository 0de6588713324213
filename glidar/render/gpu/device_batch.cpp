// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/gpu/device_batch.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/render/gpu/device_scene.hpp>
#include <glidar/render/opengl/program.hpp>
#include <glidar/render/rays/beam_search.hpp>

#include <algorithm>
#include <bit>
#include <cstring>
#include <span>
#include <utility>

namespace glidar::gpu {
namespace {

bool are_same(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

bool can_hit(const Beams& beams, std::size_t beam) {
  const bool is_in_reach =
      beams.origins_m.empty() || beams.origins_m[beam].lpNorm<1>() <= kMaxCoordinate_m;
  return is_in_reach && beams.directions[beam].allFinite();
}

}  // namespace

std::size_t DeviceBeams::bytes(const Beams& beams) {
  return (beams.directions.size() + beams.origins_m.size()) * sizeof(Eigen::Vector3d);
}

const opengl::Buffer& DeviceBeams::upload(const Beams& beams) {
  for (const Entry& entry : entries_) {
    if (are_same(entry.directions, beams.directions) && are_same(entry.origins_m, beams.origins_m))
      return entry.buffer;
  }
  Entry& entry = entries_[oldest_];
  oldest_ = (oldest_ + 1) % kEntries;
  entry.directions = beams.directions;
  entry.origins_m = beams.origins_m;
  uploaded_.clear();
  for (std::size_t i = 0; i < beams.size(); ++i) {
    uploaded_.push_back(can_hit(beams, i) ? beams.directions[i] : Eigen::Vector3d::Zero());
  }
  uploaded_.insert(uploaded_.end(), beams.origins_m.begin(), beams.origins_m.end());
  fill<Eigen::Vector3d>(entry.buffer, uploaded_, GL_STATIC_DRAW);
  return entry.buffer;
}

namespace {

constexpr GLuint kBeamsAt = 3;  // binding points of the shader
constexpr std::array<GLuint, 4> kInputBindings = {4, 5, 6, 9};
constexpr GLuint kIdsAt = 7;
constexpr GLuint kRangesAt = 8;

constexpr GLuint kHasOrigins = 1;  // bits of the shader's uniform
constexpr GLuint kHasTargets = 2;
constexpr GLuint kCulls = 4;
constexpr GLuint kWantsRanges = 8;
constexpr GLuint kWantsInstances = 16;

constexpr std::uint32_t kGroupShift = 6;  // log2 of the beams of a tile, each cast by a thread

/// A tile's shape: 8x8 beams, flatter where there are fewer rows.
std::uint32_t tile_width_shift(const Beams& beams) {
  std::uint32_t height_shift = 3;
  while (height_shift > 0 && (1U << height_shift) > beams.rows) --height_shift;
  return kGroupShift - height_shift;
}

std::uint32_t rounded_up(std::uint32_t value, std::uint32_t shift) {
  return (value + (1U << shift) - 1U) >> shift;
}

float above(double value) {
  return static_cast<float>(1.001 * value);
}

double max_reach_m(const CastRequest& request, const rays::SceneTrees& trees, std::size_t count) {
  if (request.targets.empty()) return trees.max_reach_m();
  double reach_m = 0.0;
  for (std::uint32_t i = 0; i < count; ++i) reach_m = std::max(reach_m, trees.reach_m(i));
  return reach_m;
}

}  // namespace

opengl::Program make_cast_program(const Scene& scene) {
  return opengl::make_compute_program(
      {opengl::shader_text("arithmetic.glsl"), opengl::shader_text("cast.comp.glsl")},
      {scene.instances.size() > 1 ? "STACK 24u" : "STACK 16u", "GROUP 64"});
}

DeviceBatch::~DeviceBatch() {
  if (done_ != nullptr) glDeleteSync(done_);
}

bool DeviceBatch::can_cast(const CastRequest& request, const rays::SceneTrees& trees) {
  if (request.targets.empty() && trees.groups().size() > 1) return false;
  GLint64 largest = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest);
  return DeviceBeams::bytes(request.beams) <= static_cast<std::size_t>(largest);
}

void DeviceBatch::clear() {
  frames_.clear();
  views_.clear();
  nodes_.clear();
  last_tree_ = 0;
  has_instances_ = false;
}

DeviceBatch::Frame DeviceBatch::frame_of(const InstanceView& view, const rays::MeshSphere& sphere) {
  const Eigen::Matrix3d& m = view.object_from_sensor;
  const Eigen::Vector3d& o = view.sensor_in_object;
  Frame frame{.rows = {},
              .sensor = {o.x(), o.y(), o.z(), view.scale},
              .sphere = {sphere.centre[0], sphere.centre[1], sphere.centre[2], sphere.radius},
              .reach = {},
              .mesh = {}};
  for (int row = 0; row < 3; ++row) {
    frame.rows[static_cast<std::size_t>(row)] = {m(row, 0), m(row, 1), m(row, 2), 0.0};
  }
  return frame;
}

void DeviceBatch::add_frame(std::uint32_t instance, double tie_reach_m, const DeviceScene& scene,
                            const Resolver& resolver) {
  const InstanceView& view = resolver.view(instance);
  const DeviceMesh& mesh = scene.mesh(resolver.scene().instances[instance].mesh);
  Frame& frame = frames_.emplace_back(frame_of(view, mesh.sphere));
  frame.reach = {mesh.coordinate, mesh.distance, above(tie_reach_m / view.scale), 0.0F};
  frame.mesh = {mesh.root, mesh.first_plane, scene.masked_slots(instance), instance};
}

/// Adds the nodes of the tree over a view's instances, unless they are those of the last view;
/// returns the index of the root.
std::uint32_t DeviceBatch::add_tree(const rays::SceneTrees& trees, std::size_t instances) {
  position_of_.resize(instances);
  for (std::uint32_t i = 0; i < trees.instances().size(); ++i) {
    position_of_[trees.instances()[i]] = i;
  }
  const rays::BoxTree& boxes = trees.groups().front().boxes;
  tree_ = boxes.nodes();
  const auto convert = [&](std::int32_t child) {
    if (child == rays::kNoChild) return kNone;
    if (child >= 0) return static_cast<std::uint32_t>(child);
    return kLeafBit | position_of_[boxes.index_in(static_cast<std::uint32_t>(~child))];
  };
  for (rays::TreeNode& node : tree_) {
    for (std::int32_t& child : node.child) child = std::bit_cast<std::int32_t>(convert(child));
  }
  const std::size_t bytes = tree_.size() * sizeof(rays::TreeNode);
  const bool is_same = nodes_.size() - last_tree_ == tree_.size() &&
                       std::memcmp(nodes_.data() + last_tree_, tree_.data(), bytes) == 0;
  if (!is_same) {
    last_tree_ = nodes_.size();
    nodes_.insert(nodes_.end(), tree_.begin(), tree_.end());
  }
  return static_cast<std::uint32_t>(last_tree_);
}

void DeviceBatch::add(const CastRequest& request, const DeviceScene& scene,
                      const Resolver& resolver, const rays::SceneTrees& trees) {
  const std::size_t all = resolver.scene().instances.size();
  View view{.first_frame = static_cast<std::uint32_t>(frames_.size()),
            .end_frame = 0,
            .tree_frame = kNone,
            .unused = 0};
  const double tie_reach_m = max_reach_m(request, trees, all);
  if (request.targets.empty()) {
    for (const std::uint32_t i : trees.instances()) add_frame(i, tie_reach_m, scene, resolver);
  } else {
    for (std::uint32_t i = 0; i < all; ++i) add_frame(i, tie_reach_m, scene, resolver);
  }
  view.end_frame = static_cast<std::uint32_t>(frames_.size());
  const std::uint32_t count = view.end_frame - view.first_frame;
  has_instances_ = has_instances_ || count > 1;
  if (request.targets.empty() && count > 1) {
    view.tree_frame = view.end_frame;
    const rays::MeshSphere& sphere = trees.groups().front().boxes.sphere();
    const Eigen::Vector3d centre(sphere.centre);
    Frame frame = frame_of(rays::tree_view(trees), sphere);
    frame.reach[0] = above(centre.cwiseAbs().maxCoeff() + sphere.radius);
    frame.reach[1] = above(centre.norm() + sphere.radius);
    frame.mesh = {add_tree(trees, all), 0, 0, kNone};
    frames_.push_back(frame);
  }
  views_.push_back(view);
}

void DeviceBatch::make_room(std::size_t bytes, Mapped& mapped) {
  if (bytes <= mapped.bytes) return;
  check_buffer_size(bytes);
  constexpr GLbitfield kAccess = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  const auto size = static_cast<GLsizeiptr>(bytes);
  mapped.buffer = opengl::Buffer();
  mapped.bytes = bytes;
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, mapped.buffer.name());
  glBufferStorage(GL_SHADER_STORAGE_BUFFER, size, nullptr, kAccess | GL_CLIENT_STORAGE_BIT);
  mapped.data = glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, size, kAccess);
  opengl::check_gl("making room for hits");
}

void DeviceBatch::upload(const CastRequest& request, DeviceBeams& beams) {
  fill<Frame>(inputs_[0], frames_, GL_STREAM_DRAW);
  fill<View>(inputs_[1], views_, GL_STREAM_DRAW);
  fill<rays::TreeNode>(inputs_[2], nodes_, GL_STREAM_DRAW);
  fill<InstanceRange>(inputs_[3], request.targets, GL_STREAM_DRAW);
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kInputBindings[i], inputs_[i].name());
  }
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kBeamsAt, beams.upload(request.beams).name());
}

void DeviceBatch::start(const CastRequest& request, bool with_ranges, DeviceBeams& beams) {
  constexpr std::size_t kLeast = 64;
  beams_ = request.beams.size();
  has_ranges_ = with_ranges;
  const std::size_t places = std::max(kLeast, views_.size() * beams_);
  make_room(places * sizeof(std::uint32_t) * (has_instances_ ? 2 : 1), ids_);
  make_room(with_ranges ? places * sizeof(double) : kLeast, ranges_);
  upload(request, beams);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kIdsAt, ids_.buffer.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kRangesAt, ranges_.buffer.name());
  dispatch(request);
  glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
  if (done_ != nullptr) glDeleteSync(done_);  // of a cast that was aborted
  done_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  glFlush();
  opengl::check_gl("casting");
}

void DeviceBatch::dispatch(const CastRequest& request) const {
  const Beams& beams = request.beams;
  const std::uint32_t width_shift = tile_width_shift(beams);
  glUniform3ui(0, beams.cols, beams.rows, width_shift);
  glUniform1ui(2, (beams.origins_m.empty() ? 0 : kHasOrigins) |
                      (request.targets.empty() ? 0 : kHasTargets) |
                      (request.cull_back_faces ? kCulls : 0) | (has_ranges_ ? kWantsRanges : 0) |
                      (has_instances_ ? kWantsInstances : 0));
  constexpr std::uint32_t kMaxGroups = 65535;  // that every device starts at once
  const std::uint32_t tiles =
      rounded_up(beams.cols, width_shift) * rounded_up(beams.rows, kGroupShift - width_shift);
  for (std::uint32_t first = 0; first < tiles; first += kMaxGroups) {
    glUniform1ui(1, first);
    glDispatchCompute(std::min(kMaxGroups, tiles - first), 1, static_cast<GLuint>(views_.size()));
  }
}

void DeviceBatch::wait() {
  constexpr GLuint64 kPoll_ns = 1'000'000'000;
  GLenum state = GL_TIMEOUT_EXPIRED;
  while (state == GL_TIMEOUT_EXPIRED) {
    state = glClientWaitSync(done_, GL_SYNC_FLUSH_COMMANDS_BIT, kPoll_ns);
    opengl::check_not_lost();
  }
  glDeleteSync(std::exchange(done_, nullptr));
  opengl::check_gl("casting");
}

FoundHits DeviceBatch::found(std::size_t view) const {
  const std::size_t ids = has_instances_ ? 2 : 1;
  const auto& [first, end, tree, unused] = views_[view];
  FoundHits found{
      .ids = {static_cast<const std::uint32_t*>(ids_.data) + view * beams_ * ids, beams_ * ids},
      .range_m = {},
      .has_instances = has_instances_,
      .instance = first < end ? frames_[first].mesh[3] : kNone};
  if (has_ranges_)
    found.range_m = {static_cast<const double*>(ranges_.data) + view * beams_, beams_};
  return found;
}

}  // namespace glidar::gpu
