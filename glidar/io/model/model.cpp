// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/model.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/mesh.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/io/model/import_process.hpp>
#include <glidar/io/model/model_cache.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <system_error>
#include <utility>

namespace glidar {
namespace {

template <class V>
void turn(V& v, Axis up) {
  using S = typename V::Scalar;
  const S x = v.x();
  const S y = v.y();
  const S z = v.z();
  if (up == Axis::y) {
    v.y() = S{0} - z;  // never -0
    v.z() = y;
  } else if (up == Axis::x) {
    v.x() = y;
    v.y() = z;
    v.z() = x;
  }
}

/// Calls change(origin) for every origin of the mesh.
template <class Change>
void for_origins(Mesh& mesh, const Change& change) {
  change(mesh.origin_m);
  for (MeshOrigin& run : mesh.origins) change(run.origin_m);
}

void turn_mesh(Mesh& mesh, Axis up) {
  for_origins(mesh, [up](Eigen::Vector3d& origin_m) { turn(origin_m, up); });
  for (auto& v : mesh.positions_m) turn(v, up);
  for (auto& v : mesh.normals) turn(v, up);
  for (auto& v : mesh.tangents) turn(v, up);
}

bool is_finite(Mesh& mesh) {
  bool finite = std::all_of(mesh.positions_m.begin(), mesh.positions_m.end(),
                            [](const Eigen::Vector3f& v) { return v.allFinite(); });
  for_origins(mesh,
              [&](const Eigen::Vector3d& origin_m) { finite = finite && origin_m.allFinite(); });
  return finite;
}

void require_unit(double metres_per_unit) {
  if (std::isfinite(metres_per_unit) && metres_per_unit > 0.0) return;
  throw Error({.where = "metres_per_unit",
               .found = number_text(metres_per_unit),
               .allowed = "a finite number above 0"});
}

/// The normal of the scaled surface: multiplied by the inverse transpose.
Eigen::Vector3f stretched_normal(const Eigen::Vector3f& normal, const Eigen::Vector3d& factors) {
  const Eigen::Vector3d stretched = normal.cast<double>().cwiseQuotient(factors);
  const double length = stretched.stableNorm();
  return length > 0.0 ? Eigen::Vector3f((stretched / length).cast<float>()) : normal;
}

void stretch_tangent(Eigen::Vector4f& tangent, const Eigen::Vector3d& factors) {
  const Eigen::Vector3d along = tangent.head<3>().cast<double>().cwiseProduct(factors);
  const double length = along.stableNorm();
  if (length > 0.0) tangent.head<3>() = (along / length).cast<float>();
}

/// Of a mirrored mesh: the corners in the opposite order, and the bitangents on the other side.
void reverse_fronts(Mesh& mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  for (Eigen::Vector4f& tangent : mesh.tangents) tangent.w() = -tangent.w();
}

/// Turns, scales and then moves the frames of nodes.
void move_nodes(std::vector<ModelNode>& nodes, const ModelFrame& frame,
                const Eigen::Vector3d& shift_m) {
  for (ModelNode& node : nodes) {
    Eigen::Matrix4d matrix = node.model_from_node.matrix();
    for (int column = 0; column < 4; ++column) {
      Eigen::Vector3d v = matrix.col(column).head<3>();
      if (frame.up) turn(v, *frame.up);
      matrix.col(column).head<3>() = v;
    }
    node.model_from_node.matrix() = matrix;
    node.model_from_node.translation() =
        node.model_from_node.translation() * frame.metres_per_unit.value_or(1.0) + shift_m;
  }
}

/// Makes the file's up axis z (an exact permutation of coordinates that preserves
/// handedness: y up becomes (x, -z, y), x up becomes (y, z, x)), scales to metres, and, with
/// `centre`, moves the centre of the bounding box to the origin (exactly: only the mesh's origin
/// changes). The frames of its nodes move with it. Throws Error unless the unit is finite and
/// positive, or when scaling exceeds the range of single precision.
void apply_model_frame(Model& model, const ModelFrame& frame, bool centre) {
  Mesh& mesh = model.mesh;
  const double scale = frame.metres_per_unit.value_or(1.0);
  require_unit(scale);
  if (frame.up && *frame.up != Axis::z) turn_mesh(mesh, *frame.up);
  if (scale != 1.0) {
    for_origins(mesh, [scale](Eigen::Vector3d& origin_m) { origin_m *= scale; });
    for (auto& v : mesh.positions_m) v = (v.cast<double>() * scale).cast<float>();
  }
  if (!is_finite(mesh)) {
    throw Error(
        {.where = "metres_per_unit",
         .found = number_text(scale) + " makes '" + mesh.name + "' too large for single precision",
         .remedy = "use a smaller scale"});
  }
  const Eigen::AlignedBox3d box = bounds(mesh);
  const bool moves = centre && !box.isEmpty();
  const Eigen::Vector3d middle = moves ? box.center() : Eigen::Vector3d::Zero().eval();
  if (moves) for_origins(mesh, [&](Eigen::Vector3d& origin_m) { origin_m -= middle; });
  move_nodes(model.nodes, frame, -middle);
}

/// A copy of the mesh with every coordinate multiplied by its axis' factor, which is not 0. Normals
/// are those of the scaled surface (inverse transpose), tangents are tangential to it; a mirrored
/// mesh keeps its front outside.
/// Throws Error when it exceeds the range of single precision.
Mesh scaled_copy(const Mesh& mesh, const Eigen::Vector3d& factors) {
  Mesh result = mesh;
  for_origins(result,
              [&](Eigen::Vector3d& origin_m) { origin_m = origin_m.cwiseProduct(factors); });
  for (auto& v : result.positions_m) {
    v = v.cast<double>().cwiseProduct(factors).cast<float>().array() + 0.0F;  // never -0
  }
  if (factors.prod() < 0.0) reverse_fronts(result);
  for (auto& n : result.normals) n = stretched_normal(n, factors);
  for (auto& t : result.tangents) stretch_tangent(t, factors);
  if (is_finite(result)) return result;
  throw Error({.where = "scale",
               .found = "it makes '" + mesh.name + "' too large for single precision",
               .remedy = "use smaller factors"});
}

namespace fs = std::filesystem;

void check(const ModelOptions& options) {
  const double unit = options.metres_per_unit.value_or(1.0);
  require_number(std::isfinite(unit) && unit > 0.0, "metres_per_unit", unit,
                 "a finite number above 0");
  require_number(options.crease_angle_rad >= 0.0 && options.crease_angle_rad <= std::numbers::pi,
                 "crease_angle_rad", options.crease_angle_rad, "0 to pi");
  require_number(options.time_limit_s >= 0.0 && options.time_limit_s <= 1e6, "time_limit_s",
                 options.time_limit_s, "0 (by the file's size) to 1e6");
}

[[noreturn]] void reject_model(const std::string& source, std::string found, std::string remedy) {
  throw Error({.where = source, .found = std::move(found), .remedy = std::move(remedy)});
}

fs::path model_file(const std::string& source) {
  if (source.empty() || source.find('\0') != std::string::npos) {
    reject_model("model", "an empty or invalid path", "name a model file or builtin:NAME");
  }
  std::error_code error;
  fs::path real = fs::canonical(source, error);
  if (error) {
    const std::string nearest = nearest_file(source);
    reject_model(source, "cannot be opened: " + error.message(),
                 nearest.empty() ? "check the path" : "did you mean " + nearest + "?");
  }
  if (!fs::is_regular_file(real, error)) reject_model(source, "not a file", "name a model file");
  if (fs::file_size(real, error) == 0 || error) reject_model(source, "the file is empty", "");
  return real;
}

/// The options with canonical paths of folders.
ModelOptions resolved(ModelOptions options) {
  constexpr std::size_t kMaxFolders = 64;
  if (options.texture_folders.size() > kMaxFolders) {
    throw Error({.where = "texture folder",
                 .found = std::to_string(options.texture_folders.size()) + " folders",
                 .allowed = "at most " + std::to_string(kMaxFolders),
                 .remedy = "name a folder above them"});
  }
  for (fs::path& folder : options.texture_folders) {
    std::error_code error;
    const fs::path real = fs::canonical(folder, error);
    if (error || !fs::is_directory(real, error)) {
      throw Error({.where = "texture folder",
                   .found = "'" + folder.string() + "' is not a folder",
                   .allowed = "a folder",
                   .remedy = "check the path"});
    }
    folder = real;
  }
  return options;
}

struct Loaded {
  ImportedModel imported;
  std::string hash;
  bool from_cache = false;
};

Loaded import(const fs::path& file, const ModelOptions& options, const Report& report,
              const std::optional<CacheEntry>& entry) {
  const double time_limit_s =
      options.time_limit_s > 0.0 ? options.time_limit_s : default_time_limit_s(fs::file_size(file));
  const ImportRequest request{file, options.crease_angle_rad, time_limit_s,
                              options.memory_limit_bytes, options.texture_folders};
  Loaded loaded;
  {
    const ImportRun run = run_import(request, report);
    loaded.imported = take_model(run, request);
  }
  loaded.hash = combined_hash(loaded.imported.hashes);
  // They depend on the run, not on the model.
  std::vector<std::string> sandbox_notes = std::exchange(loaded.imported.sandbox_notes, {});
  const std::string changed = changed_file(loaded.imported, file, options.texture_folders);
  if (!changed.empty()) {
    report.warn(changed + " was changed while it was read; the model has its earlier content");
  } else if (entry) {
    const std::string unwritten = write_cache(*entry, loaded.imported, file);
    if (!unwritten.empty()) report.warn(unwritten);
  }
  std::vector<std::string>& notes = loaded.imported.model.notes;
  std::move(sandbox_notes.begin(), sandbox_notes.end(), std::back_inserter(notes));
  return loaded;
}

Loaded load_file(const fs::path& file, const ModelOptions& options, const Report& report) {
  const auto entry = options.use_cache ? cache_entry(file, options, report) : std::nullopt;
  if (entry) {
    if (auto cached = read_cache(*entry, file)) {
      return {std::move(cached->imported), std::move(cached->hash), true};
    }
  }
  return import(file, options, report, entry);
}

/// Options override what the file declares.
void place(Model& model, const ModelOptions& options) {
  model.applied = {
      options.metres_per_unit ? options.metres_per_unit : model.declared.metres_per_unit,
      options.up ? options.up : model.declared.up};
  apply_model_frame(model, model.applied, options.centre);
}

std::string up_text(const std::optional<Axis>& up) {
  constexpr std::array<const char*, 3> kUnitNames = {"x", "y", "z"};
  return up ? kUnitNames.at(static_cast<std::size_t>(*up)) : "";
}

/// The mesh scaled by these factors: an existing one, or a new one. Changes nothing
/// when it throws.
std::uint32_t stretched_mesh(Scene& scene, std::uint32_t mesh, const Eigen::Vector3d& factors) {
  for (std::uint32_t i = 0; i < scene.meshes.size(); ++i) {
    if (scene.sources[i].unstretched == mesh && scene.sources[i].stretch == factors) return i;
  }
  MeshSource source = scene.sources[mesh];
  source.stretch = factors;
  source.unstretched = mesh;
  Mesh made = scaled_copy(scene.meshes[mesh], factors);
  validate(made);
  scene.sources.reserve(scene.sources.size() + 1);
  scene.meshes.push_back(std::move(made));
  scene.sources.push_back(std::move(source));
  return static_cast<std::uint32_t>(scene.meshes.size() - 1);
}

bool is_stretched(const MeshSource& source) {
  return source.stretch != Eigen::Vector3d::Ones();
}

/// Removes a scaled mesh without instances.
void drop_unused(Scene& scene, std::uint32_t mesh) {
  const auto uses = [mesh](const Instance& instance) { return instance.mesh == mesh; };
  if (!is_stretched(scene.sources[mesh]) ||
      std::any_of(scene.instances.begin(), scene.instances.end(), uses)) {
    return;
  }
  scene.meshes.erase(scene.meshes.begin() + mesh);
  scene.sources.erase(scene.sources.begin() + mesh);
  const auto move_up = [mesh](std::uint32_t& index) { index -= index > mesh ? 1U : 0U; };
  for (Instance& instance : scene.instances) move_up(instance.mesh);
  for (MeshSource& source : scene.sources) move_up(source.unstretched);
}

/// "; vertices 4 stated, 3 loaded"; empty: equal or not stated.
std::string count_difference(const char* what, const std::optional<std::uint64_t>& stated,
                             const std::optional<std::uint64_t>& loaded) {
  if (!stated || !loaded || *stated == *loaded) return "";
  return fmt::format("; {} {} stated, {} loaded", what, *stated, *loaded);
}

std::string sides_text(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return "empty";
  const Eigen::Vector3d sides = box.sizes();
  return fmt::format("{:.6g} x {:.6g} x {:.6g}", sides.x(), sides.y(), sides.z());
}

bool are_equal(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
  if (a.isEmpty() || b.isEmpty()) return a.isEmpty() == b.isEmpty();
  constexpr double kTolerance = 1e-6;
  const double allowed = kTolerance * std::max(a.sizes().maxCoeff(), b.sizes().maxCoeff());
  return ((a.min() - b.min()).array().abs() <= allowed).all() &&
         ((a.max() - b.max()).array().abs() <= allowed).all();
}

void report_contents(const Model& model, const Report& report) {
  const std::string difference = content_difference(model.stated, model.loaded);
  if (!difference.empty()) report.info(model.source + ": differs from its file: " + difference);
  for (const std::string& note : model.notes) report.info(model.source + ": " + note);
  if (model.missing_textures.empty()) return;
  std::string text = model.source + ": textures missing:";
  for (const MissingTexture& missing : model.missing_textures) {
    constexpr std::size_t kShown = 80;
    const bool longer = missing.name.size() > kShown;
    text += " '" + missing.name.substr(0, kShown) + (longer ? "..." : "") + "' (" + missing.reason +
            ")";
  }
  report.warn(text);
}

}  // namespace

std::string content_difference(const ModelContent& stated, const ModelContent& loaded) {
  std::string text = count_difference("vertices", stated.vertices, loaded.vertices) +
                     count_difference("faces", stated.faces, loaded.faces) +
                     count_difference("instances", stated.instances, loaded.instances);
  if (!stated.bounds.isEmpty() && !are_equal(stated.bounds, loaded.bounds)) {
    text += fmt::format("; size {} stated, {} loaded", sides_text(stated.bounds),
                        sides_text(loaded.bounds));
  }
  return text.empty() ? text : text.substr(2);
}

Model load_model(const std::string& source, const ModelOptions& options, const Report& report) {
  check(options);
  if (source.starts_with(kBuiltinPrefix)) {
    Model model = make_builtin_model(std::string_view(source).substr(kBuiltinPrefix.size()));
    place(model, options);
    return model;
  }
  const fs::path file = model_file(source);
  Loaded loaded = load_file(file, resolved(options), report);
  Model model = std::move(loaded.imported.model);
  model.source = source;
  model.hash = std::move(loaded.hash);
  model.files = std::move(loaded.imported.files);
  model.from_cache = loaded.from_cache;
  model.mesh.name = fs::path(source).stem().string();
  place(model, options);
  report_contents(model, report);
  return model;
}

std::size_t add_model(Scene& scene, Model model) {
  const auto first_material = static_cast<std::uint32_t>(scene.materials.size());
  const auto first_texture = static_cast<std::int32_t>(scene.textures.size());
  Instance instance;
  instance.name = model.mesh.name;
  instance.id = static_cast<std::uint32_t>(scene.instances.size() + 1);
  instance.mesh = static_cast<std::uint32_t>(scene.meshes.size());
  for (Material& material : model.materials) {
    for (TextureUse* use :
         {&material.diffuse_texture, &material.specular_texture, &material.alpha_texture,
          &material.normal_texture, &material.noise_texture}) {
      if (use->used()) use->texture += first_texture;
    }
    instance.materials.push_back(first_material +
                                 static_cast<std::uint32_t>(instance.materials.size()));
    scene.materials.push_back(std::move(material));
  }
  std::move(model.textures.begin(), model.textures.end(), std::back_inserter(scene.textures));
  scene.meshes.push_back(std::move(model.mesh));
  scene.sources.push_back({.path = std::move(model.source),
                           .hash = std::move(model.hash),
                           .files = std::move(model.files),
                           .metres_per_unit = model.applied.metres_per_unit.value_or(1.0),
                           .unit_known = model.applied.metres_per_unit.has_value(),
                           .up = up_text(model.applied.up)});
  scene.instances.push_back(std::move(instance));
  return scene.instances.size() - 1;
}

void set_scale(Scene& scene, std::size_t instance, const Eigen::Vector3d& scale) {
  const Eigen::Array3d size = scale.array().abs();
  const bool allowed = (size >= kMinScale).all() && (size <= kMaxScale).all();
  if (!allowed) {
    throw Error({.where = "scale",
                 .found = number_text(scale.x()) + ", " + number_text(scale.y()) + ", " +
                          number_text(scale.z()),
                 .allowed = "numbers from 1e-15 to 1e15, or their negatives, which mirror"});
  }
  Instance& changed = scene.instances.at(instance);
  const std::uint32_t former = changed.mesh;
  const MeshSource& source = scene.sources.at(former);
  const std::uint32_t mesh = is_stretched(source) ? source.unstretched : former;
  const bool is_uniform = scale.x() > 0.0 && scale.x() == scale.y() && scale.y() == scale.z();
  changed.mesh = is_uniform ? mesh : stretched_mesh(scene, mesh, scale);
  changed.scale = is_uniform ? scale.x() : 1.0;
  drop_unused(scene, former);
}

Eigen::Vector3d scale_of(const Scene& scene, const Instance& instance) {
  return instance.scale * scene.sources.at(instance.mesh).stretch;
}

}  // namespace glidar
