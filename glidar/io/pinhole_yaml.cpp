// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/optics_yaml.hpp>

namespace glidar {
namespace {

constexpr std::uint32_t kLargestSide = 65536;
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

}  // namespace

Pinhole read_pinhole(const YamlField& field) {
  require_map(field, {"type", "width", "height", "fov_deg", "fov_x_deg", "fx", "fy", "cx", "cy",
                      "pixel_centre", "distortion"});
  Pinhole pinhole{.intrinsics = read_intrinsics(field), .distortion = NoDistortion{}};
  if (const auto distortion = find(field, "distortion")) {
    pinhole.distortion = read_distortion(*distortion);
  }
  return pinhole;
}

}  // namespace glidar
