// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/sensor_file.hpp>

#include <glidar/io/noise_yaml.hpp>
#include <glidar/io/sensor_yaml.hpp>

#include <limits>
#include <numbers>

namespace glidar {
namespace {

constexpr std::uint32_t kLargestSide = 65536;
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr NumberRule kFieldOfView = {0.0, 180.0, true, "degrees above 0 and below 180"};

constexpr NumberRule kPixelCentre = {0.0, 1.0 - std::numeric_limits<double>::epsilon(), false,
                                     "a number from 0 to below 1; 0.5 and 0 are usual"};

double read_fov_rad(const YamlField& field) {
  return number(field, kFieldOfView) * kDegree;
}

/// Coefficients by key; those not given are 0.
void read_coefficients(const YamlField& field,
                       const std::vector<std::pair<std::string, double*>>& coefficients) {
  std::vector<std::string> known = {"model"};
  for (const auto& [key, value] : coefficients) known.push_back(key);
  require_map(field, known);
  for (const auto& [key, value] : coefficients) *value = number_or(field, key, kFinite, 0.0);
}

Distortion read_distortion(const YamlField& field) {
  static const std::vector<std::string> kModels = {"none", "radial_tangential", "fisheye"};
  if (!field.node.IsMap()) reject(field, describe(field), "a map with the key 'model'");
  const std::size_t model = one_of(need(field, "model"), kModels);
  if (model == 1) {
    RadialTangential k;
    read_coefficients(field, {{"k1", &k.k1},
                              {"k2", &k.k2},
                              {"p1", &k.p1},
                              {"p2", &k.p2},
                              {"k3", &k.k3},
                              {"k4", &k.k4},
                              {"k5", &k.k5},
                              {"k6", &k.k6}});
    return k;
  }
  if (model == 2) {
    Fisheye k;
    read_coefficients(field, {{"k1", &k.k1}, {"k2", &k.k2}, {"k3", &k.k3}, {"k4", &k.k4}});
    return k;
  }
  read_coefficients(field, {});
  return NoDistortion{};
}

/// The one way in which the map gives the focal length.
std::string focal_key(const YamlField& optics) {
  std::string chosen;
  for (const char* key : {"fov_deg", "fov_x_deg", "fx"}) {
    const auto field = find(optics, key);
    if (!field) continue;
    if (!chosen.empty()) {
      reject(*field, "given beside '" + chosen + "'", "one of fov_deg, fov_x_deg, or fx with fy",
             "remove one of them");
    }
    chosen = key;
  }
  if (!chosen.empty()) return chosen;
  reject(optics, "the focal length is missing", "one of fov_deg, fov_x_deg, or fx with fy",
         "add 'fov_deg: ...'");
}

/// fy, cx and cy belong to fx: with a field of view the pixels are square and the principal point
/// is in the middle.
void reject_beside_fov(const YamlField& optics, const std::string& fov_key) {
  for (const char* key : {"fy", "cx", "cy"}) {
    const auto field = find(optics, key);
    if (!field) continue;
    reject(*field, "given beside '" + fov_key + "'", "fy, cx and cy only together with fx",
           "remove it, or give fx and fy in the place of " + fov_key);
  }
}

PinholeIntrinsics read_intrinsics(const YamlField& optics) {
  PinholeIntrinsics k;
  k.width = whole_number(need(optics, "width"), 1, kLargestSide);
  k.height = whole_number(need(optics, "height"), 1, kLargestSide);
  k.pixel_centre = number_or(optics, "pixel_centre", kPixelCentre, k.pixel_centre);
  const std::string key = focal_key(optics);
  if (key == "fx") {
    k.fx = number(need(optics, "fx"), kAboveZero);
    k.fy = number(need(optics, "fy"), kAboveZero);
  } else {
    reject_beside_fov(optics, key);
    const double fov_rad = read_fov_rad(need(optics, key));
    // The horizontal angle gives the focal length of the image turned by 90 degrees.
    const Pinhole pinhole = key == "fov_deg" ? pinhole_from_fov(k.width, k.height, fov_rad)
                                             : pinhole_from_fov(k.height, k.width, fov_rad);
    k.fx = k.fy = pinhole.intrinsics.fy;
  }
  // The middle of the image: half its width from the left edge of pixel 0, whose centre has the
  // coordinate pixel_centre.
  k.cx = number_or(optics, "cx", kFinite, 0.5 * k.width - 0.5 + k.pixel_centre);
  k.cy = number_or(optics, "cy", kFinite, 0.5 * k.height - 0.5 + k.pixel_centre);
  return k;
}

Optics read_optics(const YamlField& field) {
  require_map(field, {"type", "width", "height", "fov_deg", "fov_x_deg", "fx", "fy", "cx", "cy",
                      "pixel_centre", "distortion"});
  if (const auto type = find(field, "type")) one_of(*type, {"pinhole"});
  Pinhole pinhole{.intrinsics = read_intrinsics(field), .distortion = NoDistortion{}};
  if (const auto distortion = find(field, "distortion")) {
    pinhole.distortion = read_distortion(*distortion);
  }
  return pinhole;
}

Limits read_depth_limits(const YamlField& field) {
  require_map(field, {"near_m", "far_m"});
  Limits limits;
  limits.near_m = number_or(field, "near_m", kFromZero, limits.near_m);
  const auto far = find(field, "far_m");
  if (!far) return limits;
  limits.far_m = number(*far, kAboveZero);
  if (limits.far_m <= limits.near_m) {
    reject(*far, describe(*far) + ", not beyond near_m", "a finite number above near_m");
  }
  return limits;
}

Light read_light(const YamlField& field) {
  require_map(field, {"attenuation", "ambient"});
  Light light;
  light.ambient = number_or(field, "ambient", kFromZero, light.ambient);
  const auto attenuation = find(field, "attenuation");
  if (!attenuation) return light;
  require_map(*attenuation, {"constant", "linear_per_m", "quadratic_per_m2"});
  const auto read = [&](const char* key, double& value) {
    value = number_or(*attenuation, key, kFromZero, value);
  };
  read("constant", light.attenuation_constant);
  read("linear_per_m", light.attenuation_linear_per_m);
  read("quadratic_per_m2", light.attenuation_quadratic_per_m2);
  if (light.attenuation_constant == 0.0 && light.attenuation_linear_per_m == 0.0 &&
      light.attenuation_quadratic_per_m2 == 0.0) {
    reject(*attenuation, "all three are 0", "at least one above 0");
  }
  return light;
}

}  // namespace

Sensor read_sensor(const YamlField& field) {
  require_map(field, {"name", "optics", "depth_limits", "light", "noise", "cull_back_faces"});
  Sensor sensor;
  if (const auto name = find(field, "name")) sensor.name = text(*name);
  sensor.optics = read_optics(need(field, "optics"));
  if (const auto limits = find(field, "depth_limits")) sensor.limits = read_depth_limits(*limits);
  if (const auto light = find(field, "light")) sensor.light = read_light(*light);
  if (const auto noise = find(field, "noise")) sensor.noise = read_noise(*noise);
  if (const auto cull = find(field, "cull_back_faces")) sensor.cull_back_faces = boolean(*cull);
  return sensor;
}

Sensor load_sensor_file(const std::filesystem::path& path) {
  return read_sensor(read_yaml(path));
}

}  // namespace glidar
