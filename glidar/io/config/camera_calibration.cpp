// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/camera_calibration.hpp>

#include <glidar/io/config/yaml_reader.hpp>
#include <glidar/io/files/text_file.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace glidar {
namespace {

std::vector<double> numbers_of(const YamlField& list, const std::vector<std::size_t>& sizes) {
  std::vector<double> numbers;
  for (const YamlField& item : items(list)) numbers.push_back(number(item, kFinite));
  if (std::ranges::find(sizes, numbers.size()) == sizes.end())
    reject(list, std::to_string(numbers.size()) + " numbers",
           fmt::format("{} numbers", fmt::join(sizes, ", ")));
  return numbers;
}

/// In OpenCV's order; coefficients that are left out are 0.
RadialTangential radial_tangential(std::vector<double> d) {
  d.resize(14);
  return {d[0], d[1], d[2], d[3], d[4], d[5], d[6], d[7], d[8], d[9], d[10], d[11], d[12], d[13]};
}

Fisheye fisheye(const std::vector<double>& d) {
  return {d[0], d[1], d[2], d[3]};
}

void note_keys(const YamlField& map, const std::vector<std::string>& used, const std::string& file,
               Sensor& sensor) {
  std::vector<std::string> unused;
  for (const auto& [key, value] : entries(map))
    if (std::ranges::find(used, key) == used.end()) unused.push_back(shown(key));
  if (unused.empty()) return;
  sensor.notes.push_back(fmt::format("{}: not used: {}", file, fmt::join(unused, ", ")));
}

/// The distortion of a camera of Kalibr, and its intrinsics before fu, fv, pu, pv.
Distortion kalibr_distortion(const YamlField& camera, std::vector<double>& intrinsics) {
  static const std::vector<std::string> kModels = {"pinhole", "omni", "ds", "eucm"};
  static const std::vector<std::string> kDistortions = {"none", "radtan", "equidistant", "fov"};
  const std::size_t model = one_of(need(camera, "camera_model"), kModels);
  const auto field = find(camera, "distortion_model");
  const std::size_t kind = field ? one_of(*field, kDistortions) : 0;
  const std::size_t most = model == 0 ? 3U : (model == 1 ? 1U : 0U);
  if (kind > most)
    reject(
        *field, "'" + kDistortions[kind] + "' with the camera model " + kModels[model],
        fmt::format("{}", fmt::join(kDistortions.begin(), kDistortions.begin() + most + 1, ", ")));
  constexpr std::array<std::size_t, 4> kCoefficients = {0, 4, 4, 1};
  std::vector<double> d;
  if (kind > 0) d = numbers_of(need(camera, "distortion_coeffs"), {kCoefficients[kind]});
  constexpr std::array<std::size_t, 4> kExtra = {0, 1, 2, 2};
  const YamlField list = need(camera, "intrinsics");
  intrinsics = numbers_of(list, {4 + kExtra[model]});
  const std::vector<double> first(intrinsics.begin(),
                                  intrinsics.begin() + static_cast<long>(kExtra[model]));
  intrinsics.erase(intrinsics.begin(), intrinsics.begin() + static_cast<long>(kExtra[model]));
  const auto check = [&](bool is_allowed, const char* allowed) {
    if (!is_allowed) reject(list, "a number out of range", allowed);
  };
  if (model == 1) {
    check(first[0] >= 0.0 && first[0] <= 1e3, "xi from 0 to 1000");
    return Omni{first[0], radial_tangential(d)};
  }
  if (model == 2) {
    check(std::abs(first[0]) < 1.0 && first[1] >= 0.0 && first[1] <= 1.0,
          "xi above -1 and below 1, alpha from 0 to 1");
    return DoubleSphere{first[0], first[1]};
  }
  if (model == 3) {
    check(first[0] >= 0.0 && first[0] <= 1.0 && first[1] > 0.0 && first[1] < 1e3,
          "alpha from 0 to 1, beta above 0 and below 1000");
    return ExtendedUnified{first[0], first[1]};
  }
  if (kind == 1) return radial_tangential(d);
  if (kind == 2) return fisheye(d);
  if (kind == 0) return NoDistortion{};
  check(d[0] > 0.0 && d[0] < std::numbers::pi, "w above 0 and below pi");
  return FieldOfView{d[0]};
}

/// Kalibr's camchain.yaml (ethz-asl/kalibr, wiki "Supported models" and "YAML formats").
void apply_kalibr(const YamlField& root, const std::string& name, const std::string& file,
                  Sensor& sensor) {
  const YamlField camera = need(root, name);
  auto& pinhole = std::get<Pinhole>(sensor.optics);
  std::vector<double> k;
  pinhole.distortion = kalibr_distortion(camera, k);
  const std::vector<YamlField> sides = items(need(camera, "resolution"));
  if (sides.size() != 2) reject(need(camera, "resolution"), "no pair", "width and height");
  pinhole.skew_px = 0.0;
  pinhole.intrinsics = {whole_number(sides[0], 1, kMaxImageSide),
                        whole_number(sides[1], 1, kMaxImageSide),
                        k[0],
                        k[1],
                        k[2],
                        k[3],
                        0.0};
  note_keys(camera,
            {"camera_model", "distortion_model", "distortion_coeffs", "intrinsics", "resolution",
             "rostopic", "cam_overlaps"},
            file + ": " + name, sensor);
}

/// The YAML of ROS' camera_calibration_parsers.
void apply_ros_camera(const YamlField& root, const std::string& file, Sensor& sensor) {
  static const std::vector<std::string> kModels = {"plumb_bob", "rational_polynomial",
                                                   "equidistant"};
  auto& pinhole = std::get<Pinhole>(sensor.optics);
  const std::vector<double> k = numbers_of(need(need(root, "camera_matrix"), "data"), {9});
  const std::size_t model = one_of(need(root, "distortion_model"), kModels);
  const YamlField list = need(need(root, "distortion_coefficients"), "data");
  pinhole.distortion = model == 2
                           ? Distortion(fisheye(numbers_of(list, {4})))
                           : Distortion(radial_tangential(numbers_of(list, {4, 5, 8, 12, 14})));
  pinhole.skew_px = k[1];
  pinhole.intrinsics = {whole_number(need(root, "image_width"), 1, kMaxImageSide),
                        whole_number(need(root, "image_height"), 1, kMaxImageSide),
                        k[0],
                        k[4],
                        k[2],
                        k[5],
                        0.0};
  note_keys(root,
            {"image_width", "image_height", "camera_name", "camera_matrix", "distortion_model",
             "distortion_coefficients"},
            file, sensor);
}

}  // namespace

void apply_camera_calibration(const std::filesystem::path& path, const std::string& name,
                              Sensor& sensor) {
  const YamlField root = read_yaml(path);
  if (find(root, "camera_matrix")) return apply_ros_camera(root, path.string(), sensor);
  apply_kalibr(root, name.empty() ? "cam0" : name, path.string(), sensor);
}

}  // namespace glidar
