// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/builtin_models.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/model/point_mesh.hpp>
#include <glidar/math/random.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

namespace glidar {
namespace {

constexpr int kIcosphereLevels = 6;  // 81,920 triangles
constexpr double kLength_m = 2.0;
// Proportions of Itokawa-like bodies: clearly longer than wide.
constexpr std::array<double, 3> kHalfAxes = {1.0, 0.70, 0.60};

/// Purposes of random numbers; the second word of the Philox key.
enum class Stream : std::uint32_t { relief, craters };
constexpr std::uint32_t kShapeSeed = 25143;  // the number of (25143) Itokawa

RandomWords draw(Stream stream, std::uint32_t a, std::uint32_t b, std::uint32_t c,
                 std::uint32_t d) {
  return philox4x32({a, b, c, d}, {kShapeSeed, static_cast<std::uint32_t>(stream)});
}

/// A random word as a number in -1..1.
double centred(std::uint32_t word) {
  return 2.0 * uniform(word) - 1.0;
}

/// Perlin's quintic: no crease in the first and second derivative at the lattice planes.
double fade(double t) {
  return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

double mix(double a, double b, double t) {
  return a + t * (b - a);
}

/// Gradient noise in about -1..1 on the integer lattice (K. Perlin, "Improving Noise", SIGGRAPH
/// 2002) with a random gradient per lattice point.
double noise(const Eigen::Vector3d& p, std::uint32_t octave) {
  const Eigen::Vector3d cell(std::floor(p.x()), std::floor(p.y()), std::floor(p.z()));
  const Eigen::Vector3d inside = p - cell;
  std::array<double, 8> corners{};
  for (std::uint32_t i = 0; i < 8; ++i) {
    const Eigen::Vector3d step(i & 1U, (i >> 1U) & 1U, (i >> 2U) & 1U);
    const auto lattice = [&](int axis) {
      return static_cast<std::uint32_t>(static_cast<std::int32_t>(cell[axis] + step[axis]));
    };
    const RandomWords words = draw(Stream::relief, lattice(0), lattice(1), lattice(2), octave);
    const Eigen::Vector3d slope(centred(words[0]), centred(words[1]), centred(words[2]));
    corners[i] = dot(slope, inside - step);
  }
  const double u = fade(inside.x());
  const double v = fade(inside.y());
  const double w = fade(inside.z());
  return mix(mix(mix(corners[0], corners[1], u), mix(corners[2], corners[3], u), v),
             mix(mix(corners[4], corners[5], u), mix(corners[6], corners[7], u), v), w);
}

/// Lumps and fine roughness, as a fraction of the radius.
double relief(const Eigen::Vector3d& p) {
  struct Octave {
    double frequency;
    double amplitude;
  };
  // The smallest wavelength, 1/26 of a half-axis, is still two edges of the mesh.
  constexpr std::array<Octave, 6> kOctaves = {
      {{1.1, 0.26}, {2.3, 0.10}, {4.9, 0.030}, {9.7, 0.013}, {17.0, 0.007}, {26.0, 0.005}}};
  double height = 0.0;
  for (std::uint32_t i = 0; i < kOctaves.size(); ++i) {
    height += kOctaves[i].amplitude * noise(kOctaves[i].frequency * p, i);
  }
  return height;
}

struct Crater {
  Eigen::Vector3d centre;  // on the ellipsoid
  double radius = 0.0;
  double depth = 0.0;
  double rim = 0.0;  // height above the ground around
};

Eigen::Vector3d on_ellipsoid(const Eigen::Vector3d& direction) {
  return {kHalfAxes[0] * direction.x(), kHalfAxes[1] * direction.y(), kHalfAxes[2] * direction.z()};
}

/// A uniform direction on the sphere: the first random point of the cube inside the unit ball.
Eigen::Vector3d random_direction(std::uint32_t index) {
  for (std::uint32_t attempt = 0;; ++attempt) {
    const RandomWords words = draw(Stream::craters, index, 0, attempt, 0);
    const Eigen::Vector3d p(centred(words[0]), centred(words[1]), centred(words[2]));
    const double length = dot(p, p);
    if (length <= 1.0 && length > 1e-4) return unit(p);
  }
}

/// Largest first, as many of radius above R as 1 / R^2: the population of a surface in
/// equilibrium (D. E. Gault, "Saturation and equilibrium conditions for impact cratering on the
/// lunar surface", Radio Science 5(2), 1970). Fresh craters are about a fifth of their diameter
/// deep, old ones shallower.
std::vector<Crater> make_craters() {
  constexpr std::uint32_t kCount = 420;
  constexpr double kMin = 0.030;
  constexpr double kMax = 0.34;
  std::vector<Crater> craters(kCount);
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const RandomWords words = draw(Stream::craters, i, 1, 0, 0);
    const double radius = std::min(kMax, kMin * std::sqrt(kCount / (i + uniform(words[0]))));
    const double freshness = uniform(words[1]);
    craters[i] = {.centre = on_ellipsoid(random_direction(i)),
                  .radius = radius * (0.75 + 0.25 * uniform(words[2])),
                  .depth = radius * (0.12 + 0.24 * freshness),
                  .rim = radius * (0.025 + 0.075 * freshness)};
  }
  return craters;
}

/// The smaller of two numbers, rounded off where they meet to within `width` (I. Quilez's quadratic
/// smooth minimum).
double soft_min(double a, double b, double width) {
  const double overlap = std::max(width - std::abs(a - b), 0.0) / width;
  return std::min(a, b) - overlap * overlap * width / 4.0;
}

constexpr double kReach = 1.9;       // extent of the ejecta blanket in crater radii
constexpr double kCrestWidth = 0.1;  // of the radius; a sharper crest would alias on this mesh

/// Adds a crater to the height so far: a bowl that meets the blanket at the rim. It removes half
/// of the older relief inside it. `t` is the distance from its centre in crater radii.
double cratered(double height, const Crater& crater, double t) {
  const double s = (kReach - t) / (kReach - 1.0);
  const double blanket = crater.rim * s * s * s;
  const double bowl = (crater.depth + crater.rim) * t * t - crater.depth;
  const double wiped = 0.5 * std::max(1.0 - t * t, 0.0);
  return height * (1.0 - wiped) + soft_min(bowl, blanket, kCrestWidth * crater.radius);
}

double crater_height(const Eigen::Vector3d& p, const std::vector<Crater>& craters) {
  double height = 0.0;
  for (const Crater& crater : craters) {
    // By components: this line runs 17 million times, unoptimised builds included.
    const double dx = p.x() - crater.centre.x();
    const double reach = kReach * crater.radius;
    if (std::abs(dx) >= reach) continue;
    const Eigen::Vector3d away(dx, p.y() - crater.centre.y(), p.z() - crater.centre.z());
    const double squared = dot(away, away);
    if (squared >= reach * reach) continue;
    height = cratered(height, crater, std::sqrt(squared) / crater.radius);
  }
  return height;
}

/// Sums the tetrahedra between the origin and the triangles.
Eigen::Vector3d centre_of_volume(const PointMesh& mesh) {
  double volume = 0.0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const auto& [i, j, k] : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.points_m[i];
    const Eigen::Vector3d& b = mesh.points_m[j];
    const Eigen::Vector3d& c = mesh.points_m[k];
    const double six_volumes = dot(a, b.cross(c));
    volume += six_volumes;
    moment += six_volumes * ((a + b) + c) / 4.0;
  }
  return moment / volume;
}

/// A cratered rock about 2 m long in x, of 81,920 triangles; its centre of volume is the origin.
PointMesh make_asteroid() {
  PointMesh mesh = icosphere(kIcosphereLevels);
  const std::vector<Crater> craters = make_craters();
  for (Eigen::Vector3d& point : mesh.points_m) {
    const Eigen::Vector3d direction = point;
    const Eigen::Vector3d ground = on_ellipsoid(direction);
    // Points move radially, so the surface cannot intersect itself.
    point = ground * (1.0 + relief(ground)) + direction * crater_height(ground, craters);
  }
  const Eigen::Vector3d centre = centre_of_volume(mesh);
  const auto by_x = [](const auto& a, const auto& b) { return a.x() < b.x(); };
  const auto [low, high] = std::minmax_element(mesh.points_m.begin(), mesh.points_m.end(), by_x);
  const double scale = kLength_m / (high->x() - low->x());
  for (Eigen::Vector3d& point : mesh.points_m) point = scale * (point - centre);
  return mesh;
}

Material neutral_grey() {
  Material material;
  material.name = "neutral grey";
  material.specular = Eigen::Vector3f::Constant(0.3F);
  material.shininess = 24.0F;
  return material;
}

/// Regolith: a warm, hardly specular grey.
Material rock() {
  Material material;
  material.name = "rock";
  material.diffuse = {0.50F, 0.46F, 0.41F};
  material.ambient = material.diffuse;
  material.specular = Eigen::Vector3f::Constant(0.03F);
  material.shininess = 6.0F;
  return material;
}

Mesh to_mesh(const PointMesh& points, const std::vector<Eigen::Vector3d>& normals) {
  Mesh mesh;
  mesh.triangles = points.triangles;
  for (const Eigen::Vector3d& p : points.points_m) mesh.positions_m.push_back(p.cast<float>());
  for (const Eigen::Vector3d& n : normals) mesh.normals.push_back(n.cast<float>());
  return mesh;
}

/// Sizes of a built-in model, m.
struct Sizes {
  Eigen::Vector3d size = Eigen::Vector3d::Constant(2.0);
  double radius = 1.0;
  double tube_radius = 0.4;
};

Mesh sphere(const Sizes& sizes) {
  PointMesh ball = icosphere(4);
  const std::vector<Eigen::Vector3d> normals = ball.points_m;  // the points of the unit sphere
  for (Eigen::Vector3d& p : ball.points_m) p *= sizes.radius;
  return to_mesh(ball, normals);
}

Mesh asteroid(const Sizes&) {
  const PointMesh body = make_asteroid();
  return to_mesh(body, smooth_normals(body));
}

/// Appends the square `centre` +- `u` +- `v` of a side of 2 m, front to u x v, with uvs.
void append_square(Mesh& mesh, const Eigen::Vector3f& centre, const Eigen::Vector3f& u,
                   const Eigen::Vector3f& v) {
  const auto first = static_cast<std::uint32_t>(mesh.positions_m.size());
  constexpr std::array<std::array<float, 2>, 4> kCorners = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (const auto& [s, t] : kCorners) {
    mesh.positions_m.emplace_back(centre + s * u + t * v);
    mesh.normals.emplace_back(u.cross(v));
    mesh.uvs[0].emplace_back((s + 1.0F) / 2.0F, (t + 1.0F) / 2.0F);
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// Scales sides of 2 m to the given lengths.
void resize(const Eigen::Vector3d& size, Mesh& mesh) {
  for (Eigen::Vector3f& p : mesh.positions_m) {
    p = p.cast<double>().cwiseProduct(0.5 * size).cast<float>();
  }
}

Mesh plane(const Sizes& sizes) {
  Mesh mesh;
  append_square(mesh, Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitX(), Eigen::Vector3f::UnitY());
  resize(sizes.size, mesh);
  return mesh;
}

Mesh box(const Sizes& sizes) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3f out = Eigen::Vector3f::Unit(axis);
    const Eigen::Vector3f u = Eigen::Vector3f::Unit((axis + 1) % 3);
    const Eigen::Vector3f v = Eigen::Vector3f::Unit((axis + 2) % 3);
    append_square(mesh, out, u, v);
    append_square(mesh, -out, v, u);
  }
  resize(sizes.size, mesh);
  return mesh;
}

/// `count` directions evenly around the circle, from +x towards +y; count = 4 * 2^n. Halving
/// arcs needs only square roots: sines and cosines differ between mathematical libraries.
std::vector<Eigen::Vector2d> circle(std::size_t count) {
  std::vector<Eigen::Vector2d> points = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  while (points.size() < count) {
    std::vector<Eigen::Vector2d> finer;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2d sum = points[i] + points[(i + 1) % points.size()];
      finer.push_back(points[i]);
      finer.emplace_back(sum / std::sqrt(sum.x() * sum.x() + sum.y() * sum.y()));
    }
    points = std::move(finer);
  }
  return points;
}

Mesh torus(const Sizes& sizes) {
  constexpr std::uint32_t kAround = 128;
  constexpr std::uint32_t kAcross = 64;
  PointMesh points;
  std::vector<Eigen::Vector3d> normals;
  const std::vector<Eigen::Vector2d> tube = circle(kAcross);
  for (const Eigen::Vector2d& ring : circle(kAround)) {
    for (const Eigen::Vector2d& t : tube) {
      const double radius = sizes.radius + sizes.tube_radius * t.x();
      points.points_m.emplace_back(radius * ring.x(), radius * ring.y(), sizes.tube_radius * t.y());
      normals.emplace_back(t.x() * ring.x(), t.x() * ring.y(), t.y());
    }
  }
  for (std::uint32_t i = 0; i < kAround; ++i) {
    for (std::uint32_t j = 0; j < kAcross; ++j) {
      const std::uint32_t here = i * kAcross;
      const std::uint32_t next = (i + 1) % kAround * kAcross;
      const std::uint32_t up = (j + 1) % kAcross;
      points.triangles.push_back({here + j, next + j, next + up});
      points.triangles.push_back({here + j, next + up, here + up});
    }
  }
  return to_mesh(points, normals);
}

struct Builtin {
  Mesh (*make)(const Sizes&);
  Material (*material)();
  int lengths;      ///< number of lengths of `size`; 0: no size
  bool has_radius;  ///< instead of a size
  bool has_tube;
};
// In the order of builtin_model_names().
constexpr std::array<Builtin, 5> kBuiltins = {{{asteroid, rock, 0, false, false},
                                               {sphere, neutral_grey, 0, true, false},
                                               {box, neutral_grey, 3, false, false},
                                               {torus, neutral_grey, 0, true, true},
                                               {plane, neutral_grey, 2, false, false}}};

std::vector<std::string> size_keys(const Builtin& builtin) {
  std::vector<std::string> keys;
  if (builtin.lengths > 0) keys.emplace_back("size");
  if (builtin.has_radius) keys.emplace_back("radius");
  if (builtin.has_tube) keys.emplace_back("tube_radius");
  return keys;
}

[[noreturn]] void refuse(std::string_view name, std::string found, std::string allowed,
                         std::string remedy) {
  throw Error({.where = std::string(kBuiltinPrefix) + excerpt(name),
               .found = std::move(found),
               .allowed = std::move(allowed),
               .remedy = std::move(remedy)});
}

/// `count` lengths, or one for all.
std::vector<double> lengths_of(std::string_view name, std::string_view text, std::size_t count) {
  std::vector<double> lengths;
  for (const std::string_view one : split(text, ',')) {
    double length = 0.0;
    const char* end = one.data() + one.size();
    const auto [stop, problem] = std::from_chars(one.data(), end, length);
    const bool is_number = problem == std::errc() && stop == end;
    if (!is_number || !(length > 0.0) || length > kMaxCoordinate_m) {
      refuse(name, "a size of '" + excerpt(one) + "'", "metres above 0, up to 1e15", "");
    }
    lengths.push_back(length);
  }
  if (lengths.size() != 1 && lengths.size() != count) {
    refuse(name, std::to_string(lengths.size()) + " numbers",
           count == 1 ? "one number" : "one number, or " + std::to_string(count), "");
  }
  lengths.resize(count, lengths.front());
  return lengths;
}

void set_size(std::string_view name, const Builtin& builtin, std::string_view parameter,
              Sizes& sizes) {
  const std::size_t equals = parameter.find('=');
  const std::string key(parameter.substr(0, equals));
  const std::vector<std::string> keys = size_keys(builtin);
  if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
    const std::string nearest = closest_match(key, keys);
    refuse(name, "'" + excerpt(key) + "' is not a size of this model",
           keys.empty() ? "no sizes; 'scale' applies to any model" : comma_separated(keys),
           nearest.empty() ? "" : "did you mean '" + nearest + "'?");
  }
  if (equals == std::string_view::npos) {
    refuse(name, "'" + key + "' without a number", key + "=NUMBER, in metres", "");
  }
  const std::string_view value = parameter.substr(equals + 1);
  if (key == "radius") sizes.radius = lengths_of(name, value, 1).front();
  if (key == "tube_radius") sizes.tube_radius = lengths_of(name, value, 1).front();
  if (key != "size") return;
  const auto count = static_cast<std::size_t>(builtin.lengths);
  const std::vector<double> lengths = lengths_of(name, value, count);
  for (std::size_t i = 0; i < count; ++i) sizes.size[static_cast<Eigen::Index>(i)] = lengths[i];
}

Sizes sizes_of(std::string_view name, const Builtin& builtin,
               std::span<const std::string_view> parameters) {
  Sizes sizes;
  std::set<std::string_view> given;
  for (const std::string_view parameter : parameters) {
    const std::string_view key = parameter.substr(0, parameter.find('='));
    set_size(name, builtin, parameter, sizes);
    if (!given.insert(key).second)
      refuse(name, "'" + std::string(key) + "' is given twice", "each size once", "");
  }
  if (builtin.has_tube && sizes.tube_radius >= sizes.radius) {
    refuse(name, "a tube of radius " + number_text(sizes.tube_radius),
           "a tube_radius below the radius, " + number_text(sizes.radius), "");
  }
  return sizes;
}

}  // namespace

std::span<const std::string> builtin_model_names() {
  static const std::array<std::string, kBuiltins.size()> kNames = {"asteroid", "sphere", "box",
                                                                   "torus", "plane"};
  return kNames;
}

Model make_builtin_model(std::string_view name) {
  const std::vector<std::string_view> parts = split(name, ':');
  const std::span<const std::string> names = builtin_model_names();
  const auto known = std::find(names.begin(), names.end(), parts.front());
  if (known == names.end()) {
    const std::string nearest = closest_match(parts.front(), names);
    refuse(name, "no built-in model of this name", comma_separated(names),
           nearest.empty() ? "" : "did you mean 'builtin:" + nearest + "'?");
  }
  const Builtin& builtin = kBuiltins.at(static_cast<std::size_t>(known - names.begin()));
  Model model;
  model.source = std::string(kBuiltinPrefix) + std::string(name);
  model.format = "built-in";
  model.declared.metres_per_unit = 1.0;
  model.mesh = builtin.make(sizes_of(name, builtin, std::span(parts).subspan(1)));
  model.mesh.name = *known;
  model.materials = {builtin.material()};
  model.parts = {{.name = *known,
                  .first_triangle = 0,
                  .triangle_count = static_cast<std::uint32_t>(model.mesh.triangles.size())}};
  return model;
}

}  // namespace glidar
