// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/gpu/device_batch.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/random.hpp>
#include <glidar/render/opengl/gl_object.hpp>
#include <glidar/render/planes.hpp>
#include <glidar/render/rays/beam_search.hpp>
#include <glidar/render/rays/mesh_tree.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace glidar::gpu {
namespace {

using rays::MeshTree;
using rays::TreeNode;

constexpr std::uint32_t kLeafCountShift = 25;
constexpr std::uint32_t kMaxTriangles = (1U << kLeafCountShift) - 64;
/// Few per leaf: neighbouring threads are mostly at different ones.
constexpr std::uint32_t kTrianglesPerLeaf = 2;
constexpr std::uint32_t kLastSlot = 31;
constexpr std::uint32_t kCopyMark = 256;

/// Three corners; the fourth components are the triangle's index in the mesh, its mark, and unused.
using DeviceTriangle = std::array<std::array<float, 4>, 3>;

/// What is uploaded.
struct Arrays {
  std::vector<TreeNode> nodes;
  std::vector<DeviceTriangle> triangles;
  std::vector<TrianglePlane> planes;
};

[[noreturn]] void fail_too_large(const std::string& found, const std::string& allowed) {
  throw Error({.where = "gpu renderer",
               .found = found,
               .allowed = allowed,
               .remedy = "use --renderer rays"});
}

/// The material's slot, and whether the triangle equals an earlier one, which the hit rule reports.
std::uint32_t mark_of(const Mesh& mesh, const std::uint32_t* first_coincident,
                      std::uint32_t triangle) {
  const std::uint32_t slot = std::min<std::uint32_t>(material_slot(mesh, triangle), kLastSlot);
  const bool is_copy = first_coincident != nullptr && first_coincident[triangle] != triangle;
  return slot + (is_copy ? kCopyMark : 0U);
}

/// Appends the triangles leaf by leaf; returns the first of each leaf.
std::vector<std::uint32_t> append_triangles(const Mesh& mesh, const MeshTree& tree,
                                            const std::uint32_t* first_coincident,
                                            std::vector<DeviceTriangle>& triangles) {
  std::vector<std::uint32_t> first;
  for (const TriangleCluster& cluster : tree.clusters) {
    first.push_back(static_cast<std::uint32_t>(triangles.size()));
    for (std::uint32_t i = 0; i < cluster.count; ++i) {
      const std::uint32_t slot = cluster.first_block * kBlockSize + i;
      const HitTriangle t = triangle_at(tree.blocks.data(), slot);
      const std::uint32_t index = tree.blocks[slot / kBlockSize].primitive[slot % kBlockSize];
      const std::uint32_t mark = mark_of(mesh, first_coincident, index);
      triangles.push_back({{{t.a[0], t.a[1], t.a[2], std::bit_cast<float>(index)},
                            {t.b[0], t.b[1], t.b[2], std::bit_cast<float>(mark)},
                            {t.c[0], t.c[1], t.c[2], 0.0F}}});
    }
  }
  return first;
}

/// Appends the tree's nodes, with the children's indices in all arrays.
void append_nodes(const MeshTree& tree, const std::vector<std::uint32_t>& first,
                  std::vector<TreeNode>& nodes) {
  const auto root = static_cast<std::uint32_t>(nodes.size());
  const auto convert = [&](std::int32_t child) {
    if (child == rays::kNoChild) return kNone;
    if (child >= 0) return root + static_cast<std::uint32_t>(child);
    const auto leaf = static_cast<std::uint32_t>(~child);
    return kLeafBit | (tree.clusters[leaf].count - 1) << kLeafCountShift | first[leaf];
  };
  for (TreeNode node : tree.nodes) {
    for (std::int32_t& child : node.child) child = std::bit_cast<std::int32_t>(convert(child));
    nodes.push_back(node);
  }
}

void append_planes(const Mesh& mesh, ThreadPool& thread_pool, std::vector<TrianglePlane>& planes) {
  constexpr std::size_t kTrianglesPerTask = 4096;
  const std::size_t first = planes.size();
  planes.resize(first + mesh.triangles.size());
  thread_pool.parallel_for(mesh.triangles.size(), kTrianglesPerTask,
                           [&](std::size_t begin, std::size_t end) {
                             for (std::size_t t = begin; t < end; ++t)
                               planes[first + t] = plane_of(mesh, static_cast<std::uint32_t>(t));
                           });
}

DeviceMesh append(const Mesh& mesh, const MeshTree& tree, const std::uint32_t* first_coincident,
                  Arrays& arrays) {
  DeviceMesh device{.first_plane = static_cast<std::uint32_t>(arrays.planes.size()),
                    .sphere = tree.sphere};
  if (!tree.nodes.empty()) device.root = static_cast<std::uint32_t>(arrays.nodes.size());
  append_nodes(tree, append_triangles(mesh, tree, first_coincident, arrays.triangles),
               arrays.nodes);
  constexpr float kRoundedUp = 1.001F;
  for (const Eigen::Vector3f& p : mesh.positions_m) {
    device.coordinate = std::max(device.coordinate, kRoundedUp * p.cwiseAbs().maxCoeff());
    device.distance = std::max(device.distance, kRoundedUp * p.norm());
  }
  return device;
}

std::uint32_t masked_slots_of(const Scene& scene, const Instance& instance) {
  std::uint32_t slots = 0;
  for (std::uint32_t slot = 0; slot < instance.materials.size(); ++slot) {
    const bool is_masked = scene.materials[instance.materials[slot]].alpha_cutoff > 0.0F;
    slots |= static_cast<std::uint32_t>(is_masked) << std::min(slot, kLastSlot);
  }
  return slots;
}

/// Resolver::first_coincident() of the mesh's first instance that has it.
std::vector<const std::uint32_t*> first_coincident_of(const Resolver& resolver) {
  const Scene& scene = resolver.scene();
  std::vector<const std::uint32_t*> of_mesh(scene.meshes.size(), nullptr);
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const std::uint32_t*& first = of_mesh[scene.instances[i].mesh];
    if (first == nullptr) first = resolver.first_coincident(i);
  }
  return of_mesh;
}

}  // namespace

void check_buffer_size(std::size_t bytes) {
  GLint64 largest = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest);
  if (bytes <= static_cast<std::size_t>(largest)) return;
  fail_too_large("a buffer of " + std::to_string(bytes) + " bytes",
                 "up to " + std::to_string(largest) + " on this graphics device");
}

DeviceScene::DeviceScene(const Resolver& resolver, ThreadPool& thread_pool) {
  const Scene& scene = resolver.scene();
  std::size_t triangles = 0;
  for (const Mesh& mesh : scene.meshes) triangles += mesh.triangles.size();
  if (triangles > kMaxTriangles) {
    fail_too_large(std::to_string(triangles) + " triangles in all meshes",
                   "up to " + std::to_string(kMaxTriangles));
  }
  Arrays arrays;
  const std::vector<const std::uint32_t*> first_coincident = first_coincident_of(resolver);
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    const Mesh& mesh = scene.meshes[i];
    const MeshTree tree = rays::build_mesh_tree({.positions = mesh.positions_m,
                                                 .triangles = mesh.triangles,
                                                 .chosen = resolver.distinct(i)},
                                                {.cluster_size = kTrianglesPerLeaf}, thread_pool);
    meshes_.push_back(append(mesh, tree, first_coincident[i], arrays));
    append_planes(mesh, thread_pool, arrays.planes);
  }
  for (const Instance& instance : scene.instances) {
    masked_slots_.push_back(masked_slots_of(scene, instance));
  }
  static_assert(sizeof(TreeNode) == std::size_t{64} * sizeof(float));
  static_assert(sizeof(TrianglePlane) == 4 * sizeof(double));
  fill<TreeNode>(buffers_[0], arrays.nodes, GL_STATIC_DRAW);
  fill<DeviceTriangle>(buffers_[1], arrays.triangles, GL_STATIC_DRAW);
  fill<TrianglePlane>(buffers_[2], arrays.planes, GL_STATIC_DRAW);
  opengl::check_gl("taking the scene into the graphics device's memory");
}

void DeviceScene::bind() const {
  for (GLuint i = 0; i < buffers_.size(); ++i) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, buffers_[i].name());
  }
}

namespace {

using Four = std::array<double, 4>;

/// Inputs of a range; the fourth component of `sensor` is the scale, that of `plane` the offset.
struct Case {
  std::array<Four, 3> rows;
  Four sensor;
  Four beam;
  Four offset;
  Four plane;
};

constexpr std::uint32_t kGroup = 64;  // as in the shader
constexpr std::uint32_t kCases = 64 * kGroup;

Four random_four(std::uint32_t block) {
  Four numbers;
  for (std::uint32_t k = 0; k < 4; ++k) {
    const RandomWords words = random_words({.seed = 2, .block = 4 * block + k});
    numbers[k] = (uniform(words[0]) - 0.5) + 0x1p-32 * (uniform(words[1]) - 0.5);
  }
  return numbers;
}

std::vector<Case> random_cases() {
  std::vector<Case> cases(kCases);
  std::uint32_t block = 0;
  for (Case& c : cases) {
    for (Four* four : {c.rows.data(), c.rows.data() + 1, c.rows.data() + 2, &c.sensor, &c.beam,
                       &c.offset, &c.plane}) {
      *four = random_four(block++);
    }
  }
  return cases;
}

double ordered_dot(const Four& a, const Four& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Four turned(const Case& c, const Four& v) {
  return {ordered_dot(c.rows[0], v), ordered_dot(c.rows[1], v), ordered_dot(c.rows[2], v), 0.0};
}

double range_of(const Case& c) {
  Four origin = turned(c, c.offset);
  for (std::size_t k = 0; k < 3; ++k) origin[k] = c.sensor[k] + origin[k] / c.sensor[3];
  const double above = c.plane[3] - ordered_dot(c.plane, origin);
  return above / ordered_dot(c.plane, turned(c, c.beam)) * c.sensor[3];
}

std::vector<double> ranges_on_device(const std::vector<Case>& cases) {
  const opengl::Program program = opengl::make_compute_program(
      {opengl::shader_text("arithmetic.glsl"), opengl::shader_text("arithmetic_check.comp.glsl")},
      {});
  const std::array<opengl::Buffer, 2> buffers;
  std::vector<double> ranges(cases.size());
  fill<Case>(buffers[0], cases, GL_STATIC_DRAW);
  fill<double>(buffers[1], ranges, GL_STATIC_READ);
  for (GLuint i = 0; i < buffers.size(); ++i) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, buffers[i].name());
  }
  glUseProgram(program.name());
  glDispatchCompute(kCases / kGroup, 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffers[1].name());
  glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0,
                     static_cast<GLsizeiptr>(ranges.size() * sizeof(double)), ranges.data());
  glUseProgram(0);
  opengl::check_gl("comparing the device's arithmetic");
  return ranges;
}

[[noreturn]] void refuse(const std::string& found) {
  const char* name = std::bit_cast<const char*>(glGetString(GL_RENDERER));
  throw Error({.where = "gpu renderer",
               .found = std::string(name) + " has " + found,
               .allowed = "OpenGL 4.3 with compute shaders, GL_ARB_buffer_storage and exact 64-bit "
                          "numbers",
               .remedy = "choose another --graphics-device, or use --renderer rays"});
}

}  // namespace

void check_device() {
  constexpr int kMinVersion = 43;
  const int version = epoxy_gl_version();
  if (version < kMinVersion) {
    refuse("OpenGL " + std::to_string(version / 10) + "." + std::to_string(version % 10));
  }
  if (version == kMinVersion && !epoxy_has_gl_extension("GL_ARB_buffer_storage")) {
    refuse("no GL_ARB_buffer_storage");
  }
  const std::vector<Case> cases = random_cases();
  const std::vector<double> ranges = ranges_on_device(cases);
  std::size_t others = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const bool is_same =
        std::bit_cast<std::uint64_t>(ranges[i]) == std::bit_cast<std::uint64_t>(range_of(cases[i]));
    others += is_same ? 0 : 1;
  }
  if (others == 0) return;
  refuse("another arithmetic than the processor (" + std::to_string(others) + " of " +
         std::to_string(cases.size()) + " numbers differ)");
}

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
