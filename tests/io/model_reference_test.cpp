// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

// The ground truth of reference/core: every stable pixel has a triangle of the model and its
// distance. Here only the loader is on trial: the named triangle must lie where the pixel's ray is,
// at that distance.

#include <glidar/io/model/model.hpp>
#include <glidar/math/constants.hpp>

#include <io/model_test_support.hpp>

#include <nlohmann/json.hpp>

#include <Eigen/LU>
#include <cmath>
#include <cstring>

namespace glidar {
namespace {

namespace fs = std::filesystem;

/// The numbers of a little-endian C-order .npy file.
template <class T>
std::vector<T> read_npy(const fs::path& path) {
  const std::string file = testing::read_file(path);
  std::uint16_t head = 0;
  std::memcpy(&head, file.data() + 8, sizeof head);
  const std::size_t start = 10U + head;
  std::vector<T> values((file.size() - start) / sizeof(T));
  std::memcpy(values.data(), file.data() + start, values.size() * sizeof(T));
  return values;
}

struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d
      direction;  ///< z = 1 in the camera, or unit: the parameter is the case's distance
};

struct Case {
  std::string model;
  std::vector<Ray> rays;
  std::vector<float> distance;
};

Eigen::Vector3d vector(const nlohmann::json& j) {
  return {j[0].get<double>(), j[1].get<double>(), j[2].get<double>()};
}

std::vector<Ray> pinhole_rays(const nlohmann::json& p) {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d origin;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) rotation(r, c) = p["camera_to_world"][r][c].get<double>();
    origin[r] = p["camera_to_world"][r][3].get<double>();
  }
  std::vector<Ray> rays;
  for (int v = 0; v < p["height"]; ++v) {
    for (int u = 0; u < p["width"]; ++u) {
      const Eigen::Vector3d in_camera((u + 0.5 - p["cx"].get<double>()) / p["fx"].get<double>(),
                                      (v + 0.5 - p["cy"].get<double>()) / p["fy"].get<double>(),
                                      1.0);
      rays.push_back({origin, rotation * in_camera});
    }
  }
  return rays;
}

std::vector<Ray> lidar_rays(const nlohmann::json& p, std::size_t count) {
  const std::size_t columns = count / p["elevation_deg"].size();
  const Eigen::Vector3d reported = vector(p["origin"]);
  // Files of z up were turned to y up for the reference.
  const Eigen::Vector3d origin =
      p["up_axis"] == "y" ? Eigen::Vector3d(reported.x(), -reported.z(), reported.y()) : reported;
  std::vector<Ray> rays;
  for (const nlohmann::json& elevation_deg : p["elevation_deg"]) {
    const double elevation = elevation_deg.get<double>();
    for (std::size_t i = 0; i < columns; ++i) {
      const double azimuth = p["yaw0_deg"].get<double>() +
                             360.0 * static_cast<double>(i) / static_cast<double>(columns);
      const double ce = std::cos(elevation * kDegree);
      const double se = std::sin(elevation * kDegree);
      const double ca = std::cos(azimuth * kDegree);
      const double sa = std::sin(azimuth * kDegree);
      rays.push_back({origin, {ce * ca, ce * sa, se}});
    }
  }
  return rays;
}

Case read_case(const fs::path& folder) {
  const auto p = nlohmann::json::parse(testing::read_file(folder / "params.json"));
  Case result;
  result.model = p["model"];
  const bool pinhole = p["type"] == "pinhole";
  result.distance = read_npy<float>(folder / (pinhole ? "depth_z.npy" : "range.npy"));
  result.rays = pinhole ? pinhole_rays(p) : lidar_rays(p, result.distance.size());
  return result;
}

/// Distance along the ray and barycentrics of corners 1 and 2, on the triangle's plane.
Eigen::Vector3d meet(const Mesh& mesh, const Triangle& t, const Ray& ray) {
  const Eigen::Vector3d a = vertex_m(mesh, t[0]);
  Eigen::Matrix3d system;
  system.col(0) = -ray.direction;
  system.col(1) = (mesh.positions_m[t[1]] - mesh.positions_m[t[0]]).cast<double>();
  system.col(2) = (mesh.positions_m[t[2]] - mesh.positions_m[t[0]]).cast<double>();
  return system.fullPivLu().solve(ray.origin - a);
}

class ModelReference : public ::testing::TestWithParam<const char*> {};

TEST_P(ModelReference, TheReferenceTrianglesAreHitByTheirRays) {
  GLIDAR_NEEDS_DATA();
  const fs::path folder = testing::data_folder() / "reference" / "core" / GetParam();
  const Case truth = read_case(folder);
  const auto triangle = read_npy<std::int32_t>(folder / "triangle_id.npy");
  const auto stable = read_npy<std::uint8_t>(folder / "stable_mask.npy");
  const bool textured = fs::exists(folder / "uv.npy");
  const auto uv = textured ? read_npy<float>(folder / "uv.npy") : std::vector<float>();
  ModelOptions options = testing::as_declared();  // the references are in metres
  options.up = Axis::z;                           // with the axes of the file
  const Mesh mesh = testing::load(testing::data_folder() / truth.model, options).mesh;
  std::size_t looked_at = 0;
  for (std::size_t i = 0; i < triangle.size(); ++i) {
    if (triangle[i] < 0 || stable[i] == 0) continue;
    const Triangle& t = mesh.triangles.at(static_cast<std::size_t>(triangle[i]));
    const Eigen::Vector3d hit = meet(mesh, t, truth.rays[i]);
    ASSERT_NEAR(hit[0], double{truth.distance[i]}, 1e-6 * (1.0 + double{truth.distance[i]})) << i;
    ASSERT_GT(hit.tail<2>().minCoeff(), -1e-4) << i;
    ASSERT_LT(hit.tail<2>().sum(), 1.0 + 1e-4) << i;
    ++looked_at;
    if (!textured) continue;
    const auto& map = mesh.uvs[0];
    const auto b = hit.cast<float>();
    const Eigen::Vector2f at =
        (1.0F - b[1] - b[2]) * map[t[0]] + b[1] * map[t[1]] + b[2] * map[t[2]];
    ASSERT_LT((at - Eigen::Vector2f(uv[2 * i], uv[2 * i + 1])).norm(), 1e-4F) << i;
  }
  EXPECT_GT(looked_at, 100U);
}

INSTANTIATE_TEST_SUITE_P(Core, ModelReference,
                         ::testing::Values("apartment_vlp16", "bunny_front", "bunny_top",
                                           "bunny_wide120", "dragon_full", "duck_texture",
                                           "fuze_texture", "itokawa", "orientation_test",
                                           "rmagine_sphere_inside", "toyblocks_cube", "zarya"),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace glidar
