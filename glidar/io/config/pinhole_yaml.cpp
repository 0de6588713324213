// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/optics_yaml.hpp>

#include <glidar/core/error.hpp>

namespace glidar {
namespace {

constexpr NumberRule kFieldOfView = {0.0, 180.0, true, "degrees above 0 and below 180"};

constexpr NumberRule kPixelCentre = {0.0, 1.0 - std::numeric_limits<double>::epsilon(), false,
                                     "a number from 0 to below 1; 0.5 and 0 are usual"};

constexpr NumberRule kFocalLength = {0.0, kFarthestPixel, true, "pixels above 0 and below 1e9"};
constexpr NumberRule kPrincipalPoint = {-kFarthestPixel, kFarthestPixel, false,
                                        "pixels from -1e9 to 1e9"};

/// Of an image with this many pixels along the side that the field of view spans.
double read_focal_length(const YamlField& field, std::uint32_t side) {
  const double focal = focal_length_px(side, number(field, kFieldOfView) * kDegree);
  if (focal > 0.0 && focal < kFarthestPixel) return focal;
  reject(field, describe(field) + ", a focal length of " + number_text(focal) + " pixels",
         "a field of view that gives pixels above 0 and below 1e9");
}

/// Coefficients by key; those not given are 0. `others` are keys that somebody else reads.
void read_coefficients(const YamlField& field,
                       const std::vector<std::pair<std::string, double*>>& coefficients,
                       const std::vector<std::string>& others = {}) {
  std::vector<std::string> known = {"model"};
  for (const auto& [key, value] : coefficients) known.push_back(key);
  known.insert(known.end(), others.begin(), others.end());
  require_map(field, known);
  for (const auto& [key, value] : coefficients) *value = number_or(field, key, kFinite, 0.0);
}

Distortion read_distortion(const YamlField& field) {
  static const std::vector<std::string> kModels = {"none", "radial_tangential", "fisheye"};
  if (!field.node.IsMap()) reject(field, describe(field), "a map with the key 'model'");
  const std::size_t model = one_of(need(field, "model"), kModels);
  if (model == 1) {
    RadialTangential k;
    read_coefficients(field,
                      {{"k1", &k.k1},
                       {"k2", &k.k2},
                       {"p1", &k.p1},
                       {"p2", &k.p2},
                       {"k3", &k.k3},
                       {"k4", &k.k4},
                       {"k5", &k.k5},
                       {"k6", &k.k6}},
                      {"max_radius"});
    k.max_radius = number_or(field, "max_radius", kAboveZero, k.max_radius);
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
  k.width = whole_number(need(optics, "width"), 1, kMaxImageSide);
  k.height = whole_number(need(optics, "height"), 1, kMaxImageSide);
  k.pixel_centre = number_or(optics, "pixel_centre", kPixelCentre, k.pixel_centre);
  const std::string key = focal_key(optics);
  if (key == "fx") {
    k.fx = number(need(optics, "fx"), kFocalLength);
    k.fy = number(need(optics, "fy"), kFocalLength);
  } else {
    reject_beside_fov(optics, key);
    k.fx = k.fy = read_focal_length(need(optics, key), key == "fov_deg" ? k.height : k.width);
  }
  // The middle of the image: half its width from the left edge of pixel 0, whose centre has the
  // coordinate pixel_centre.
  k.cx = number_or(optics, "cx", kPrincipalPoint, 0.5 * k.width - 0.5 + k.pixel_centre);
  k.cy = number_or(optics, "cy", kPrincipalPoint, 0.5 * k.height - 0.5 + k.pixel_centre);
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
