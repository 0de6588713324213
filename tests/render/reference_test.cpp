// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// External references: brute force in double precision, images from the OpenGL renderer of another
// program, and a real scanner.
#include <glidar/render/renderer.hpp>
#include <render/renderer_suite.hpp>
#include <support/data.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

namespace glidar {
namespace {

using nlohmann::json;

json read_json(const std::filesystem::path& path) {
  std::ifstream file(path);
  return json::parse(file);
}

Pose pose_from(const json& rows) {
  Pose pose = Pose::Identity();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) pose.matrix()(r, c) = rows[r][c].get<double>();
  }
  return pose;
}

Beams pinhole_beams(const json& k, double pixel_centre) {
  Beams beams;
  beams.rows = k["height"];
  beams.cols = k["width"];
  beams.frame_id = "camera_optical_frame";
  for (std::uint32_t v = 0; v < beams.rows; ++v) {
    for (std::uint32_t u = 0; u < beams.cols; ++u) {
      const double x = (u + pixel_centre - k["cx"].get<double>()) / k["fx"].get<double>();
      const double y = (v + pixel_centre - k["cy"].get<double>()) / k["fy"].get<double>();
      beams.directions.push_back(Eigen::Vector3d(x, y, 1.0).normalized());
    }
  }
  beams.pinhole = PinholeIntrinsics{.width = beams.cols,
                                    .height = beams.rows,
                                    .fx = k["fx"],
                                    .fy = k["fy"],
                                    .cx = k["cx"],
                                    .cy = k["cy"],
                                    .pixel_centre = pixel_centre};
  return beams;
}

Beams spinning_beams(const json& params) {
  Beams beams;
  const std::string azimuths = params["azimuth_deg"];  // "yaw0 + i*360/N, i=0..N-1"
  beams.cols = static_cast<std::uint32_t>(std::stoul(azimuths.substr(azimuths.find('/') + 1)));
  beams.rows = static_cast<std::uint32_t>(params["elevation_deg"].size());
  beams.frame_id = "lidar";
  const double degree = std::numbers::pi / 180.0;
  for (const double elevation_deg : params["elevation_deg"]) {
    for (std::uint32_t i = 0; i < beams.cols; ++i) {
      const double e = elevation_deg * degree;
      const double a = (params["yaw0_deg"].get<double>() + i * 360.0 / beams.cols) * degree;
      beams.directions.push_back(
          Eigen::Vector3d(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e))
              .normalized());
    }
  }
  return beams;
}

/// Position of a scanner in the model's own axes. Files of z up were rotated to y up for the
/// reference.
Eigen::Vector3d scanner_origin(const json& params) {
  const json& o = params["origin"];
  if (params["up_axis"] == "y")
    return {o[0].get<double>(), -o[2].get<double>(), o[1].get<double>()};
  return {o[0].get<double>(), o[1].get<double>(), o[2].get<double>()};
}

constexpr double kSingle = 6e-8;  // one rounding to single precision

/// Distance of a point of a triangle's plane from the triangle; negative inside.
double outside_m(const Mesh& mesh, std::uint32_t triangle, const Eigen::Vector3d& point) {
  std::array<Eigen::Vector3d, 3> v;
  for (std::size_t k = 0; k < 3; ++k) {
    v[k] = mesh.origin_m + mesh.positions_m[mesh.triangles[triangle][k]].cast<double>();
  }
  const Eigen::Vector3d normal = (v[1] - v[0]).cross(v[2] - v[0]).normalized();
  double outside = std::abs(normal.dot(point - v[0]));
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d edge = v[(k + 1) % 3] - v[k];
    outside = std::max(outside, -normal.dot(edge.cross(point - v[k])) / edge.norm());
  }
  return outside;
}

/// External results for a case's beams.
struct Reference {
  bool is_depth;                  ///< along the boresight; else range along the beam
  std::vector<float> distance_m;  ///< 0: no hit
  std::vector<std::int32_t> triangle;
  std::vector<std::uint8_t> is_stable;  ///< not near a silhouette
  std::vector<float> cosine;            ///< of incidence
};

Reference read_reference(const std::filesystem::path& folder, bool is_pinhole) {
  return {
      .is_depth = is_pinhole,
      .distance_m = testing::read_npy<float>(folder / (is_pinhole ? "depth_z.npy" : "range.npy")),
      .triangle = testing::read_npy<std::int32_t>(folder / "triangle_id.npy"),
      .is_stable = testing::read_npy<std::uint8_t>(folder / "stable_mask.npy"),
      .cosine = testing::read_npy<float>(folder / "abs_cos_incidence.npy")};
}

void expect_reference(const Scene& scene, const Reference& reference, const Hits& hits) {
  // The reference rounds depths and vertices to single precision: a few roundings of the largest
  // coordinate, seen along the surface at up to 1 / cosine.
  const double coordinate =
      bounds(scene).max().cwiseAbs().cwiseMax(bounds(scene).min().cwiseAbs()).maxCoeff();
  std::size_t compared = 0;
  std::size_t on_both = 0;
  for (std::size_t i = 0; i < reference.distance_m.size(); ++i) {
    if (reference.is_stable[i] == 0) continue;
    ++compared;
    const double distance_m = reference.distance_m[i];
    ASSERT_EQ(hits.instance[i] != kInvalidId, distance_m != 0.0) << "beam " << i;
    if (distance_m == 0.0) continue;
    const auto theirs = static_cast<std::uint32_t>(reference.triangle[i]);
    if (hits.primitive[i] != theirs) {
      // Valid only where both triangles contain the beam's point, within single precision: at a
      // common edge, or on coincident surfaces.
      ++on_both;
      EXPECT_LT(outside_m(scene.meshes[0], hits.primitive[i], hits.object_point_m[i]), 1e-12);
      EXPECT_LT(outside_m(scene.meshes[0], theirs, hits.object_point_m[i]), kSingle * distance_m)
          << "beam " << i;
      continue;
    }
    const double found = reference.is_depth ? hits.depth_m[i] : hits.range_m[i];
    const double cosine = reference.cosine[i];
    const double tolerance = 4.0 * kSingle * (coordinate / std::max(cosine, 0.01) + distance_m);
    EXPECT_NEAR(found, distance_m, tolerance) << "beam " << i;
    EXPECT_NEAR(hits.cos_incidence[i], cosine, 1e-3) << "beam " << i;
  }
  EXPECT_GT(compared, reference.distance_m.size() / 2);
  // Zarya and the apartment have coincident surfaces within single precision.
  EXPECT_LE(on_both, compared / 100);
}

class ReferenceCase : public ::testing::TestWithParam<std::string> {};

TEST_P(ReferenceCase, StableBeamsHitTheReferenceTriangleAtTheReferenceDepth) {
  GLIDAR_NEEDS_DATA();
  const std::filesystem::path folder = testing::data_folder() / "reference/core" / GetParam();
  const json params = read_json(folder / "params.json");
  const bool is_pinhole = params["type"] == "pinhole";
  const Beams beams = is_pinhole ? pinhole_beams(params, 0.5) : spinning_beams(params);
  Pose world_from_sensor = Pose::Identity();
  if (is_pinhole) {
    world_from_sensor = pose_from(params["camera_to_world"]);
  } else {
    world_from_sensor.translation() = scanner_origin(params);
  }
  const Scene scene = testing::scene_of(testing::load_data_model(params["model"]));
  ASSERT_EQ(scene.meshes[0].triangles.size(), params["triangles"].get<std::size_t>());
  const Reference reference = read_reference(folder, is_pinhole);
  ASSERT_EQ(reference.distance_m.size(), beams.size());
  for (const std::string& kind : renderer_kinds()) {
    if (!is_pinhole && kind == "raster") continue;  // they refuse such beams
    if (kind == "gpu" && !testing::missing_gpu().empty()) continue;
    SCOPED_TRACE(kind);
    Hits hits;
    make_renderer(scene, {.kind = kind})
        ->cast({.beams = beams,
                .world_from_sensor = world_from_sensor,
                .world_from_instance = {},
                .hit_columns = {.depth = true, .incidence = true, .object_point = true}},
               hits);
    expect_reference(scene, reference, hits);
  }
}

INSTANTIATE_TEST_SUITE_P(Core, ReferenceCase,
                         ::testing::Values("apartment_vlp16", "bunny_front", "bunny_top",
                                           "bunny_wide120", "dragon_full", "duck_texture",
                                           "fuze_texture", "itokawa", "orientation_test",
                                           "rmagine_sphere_inside", "toyblocks_cube", "zarya"),
                         [](const auto& test) { return test.param; });

/// Compares colours at the hits with nearest-texel look-ups by another program.
class TextureCase : public ::testing::TestWithParam<std::string> {};

TEST_P(TextureCase, UvsInterpolateAsInTheReference) {
  GLIDAR_NEEDS_DATA();
  const std::filesystem::path folder = testing::data_folder() / "reference/core" / GetParam();
  const json params = read_json(folder / "params.json");
  const Beams beams = pinhole_beams(params, 0.5);
  const Scene scene = testing::scene_of(testing::load_data_model(params["model"]));
  Hits hits;
  make_renderer(scene, {})->cast({.beams = beams,
                                  .world_from_sensor = pose_from(params["camera_to_world"]),
                                  .world_from_instance = {},
                                  .hit_columns = {.barycentrics = true}},
                                 hits);
  const auto uv = testing::read_npy<float>(folder / "uv.npy");
  const auto stable = testing::read_npy<std::uint8_t>(folder / "stable_mask.npy");
  const Mesh& mesh = scene.meshes[0];
  std::size_t compared = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (stable[i] == 0 || hits.instance[i] == kInvalidId) continue;
    ++compared;
    const Triangle& t = mesh.triangles[hits.primitive[i]];
    const Eigen::Vector2f w = hits.barycentrics[i];
    const Eigen::Vector2f found = (1.0F - w.x() - w.y()) * mesh.uvs[0][t[0]] +
                                  w.x() * mesh.uvs[0][t[1]] + w.y() * mesh.uvs[0][t[2]];
    EXPECT_NEAR(found.x(), uv[2 * i], 2e-4) << "beam " << i;
    EXPECT_NEAR(found.y(), uv[2 * i + 1], 2e-4) << "beam " << i;
  }
  EXPECT_GT(compared, 3000U);
}

INSTANTIATE_TEST_SUITE_P(Core, TextureCase, ::testing::Values("duck_texture", "fuze_texture"),
                         [](const auto& test) { return test.param; });

TEST(M3tOpengl, DepthImageAndSilhouetteEqualTheReference) {
  GLIDAR_NEEDS_DATA();
  const std::filesystem::path folder = testing::data_folder() / "reference/m3t_opengl";
  const json params = read_json(folder / "params.json");
  const Beams beams = pinhole_beams(params["intrinsics"], 0.0);  // pixel centres at integers there
  Scene scene;
  for (const char* name : {"triangle", "schauma"}) {
    const json& body = params["bodies"][name];
    const std::size_t i = add_model(scene, testing::load_data_model(body["mesh"]));
    scene.instances[i].world_from_object =
        pose_from(body["world2body"]).inverse(Eigen::Affine) * pose_from(body["geometry2body"]);
    // Printed with six digits, so it must be orthonormalised.
    Eigen::Matrix3d rotation = scene.instances[i].world_from_object.linear();
    rotation = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
    scene.instances[i].world_from_object.linear() = rotation;
  }
  Hits hits;
  make_renderer(scene, {})->cast(
      {.beams = beams,
       .world_from_sensor = pose_from(params["world2camera"]).inverse(Eigen::Affine),
       .world_from_instance = {},
       .hit_columns = {.depth = true},
       .cull_back_faces = true},
      hits);
  const auto depth = testing::read_npy<float>(folder / "depth_z_m.npy");
  std::size_t both = 0;
  std::size_t differ = 0;
  double largest = 0.0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const bool theirs = std::isfinite(depth[i]) && depth[i] > 0.0F && depth[i] < 1.99F;
    const bool ours = hits.instance[i] != kInvalidId;
    if (theirs != ours) ++differ;
    if (!theirs || !ours) continue;
    ++both;
    largest = std::max(largest, std::abs(hits.depth_m[i] - depth[i]));
  }
  EXPECT_EQ(both + differ, 27335U);
  EXPECT_LE(differ, 3U);       // the poses are known to six digits only
  EXPECT_LT(largest, 0.2e-3);  // the program's 16-bit depth steps are up to 0.06 mm here
}

TEST(StanfordScan, TheRenderedBunnyMatchesTheScan) {
  GLIDAR_NEEDS_DATA();
  const std::filesystem::path folder = testing::data_folder() / "recordings/stanford_bunny_scans";
  std::ifstream file(folder / "bun000.ply");
  std::string line;
  std::size_t points = 0;
  while (std::getline(file, line) && line.rfind("end_header", 0) != 0) {
    if (line.rfind("element vertex", 0) == 0) points = std::stoul(line.substr(15));
  }
  // bun.conf places bun000 at the identity; the scanner looks along -z, all its beams parallel.
  Beams beams;
  beams.rows = 1;
  beams.cols = static_cast<std::uint32_t>(points);
  beams.frame_id = "scanner";
  std::vector<double> scanned_z;
  constexpr double kStart = 1.0;
  for (std::size_t i = 0; i < points; ++i) {
    std::getline(file, line);
    std::istringstream numbers(line);
    Eigen::Vector3d p;
    numbers >> p.x() >> p.y() >> p.z();
    beams.origins_m.push_back({p.x(), p.y(), kStart});
    beams.directions.push_back(-Eigen::Vector3d::UnitZ());
    scanned_z.push_back(p.z());
  }
  const Scene scene = testing::scene_of(testing::load_data_model("models/stanford/bun_zipper.ply"));
  Hits hits;
  make_renderer(scene, {})->cast({.beams = beams,
                                  .world_from_sensor = Pose::Identity(),
                                  .world_from_instance = {},
                                  .hit_columns = {}},
                                 hits);
  std::vector<double> distance;
  for (std::size_t i = 0; i < points; ++i) {
    if (hits.instance[i] != kInvalidId) {
      distance.push_back(std::abs(kStart - hits.range_m[i] - scanned_z[i]));
    }
  }
  ASSERT_GT(distance.size(), points * 98 / 100);
  std::vector<double> signed_distance;
  for (std::size_t i = 0; i < points; ++i) {
    if (hits.instance[i] != kInvalidId) {
      signed_distance.push_back(kStart - hits.range_m[i] - scanned_z[i]);
    }
  }
  std::nth_element(
      signed_distance.begin(),
      signed_distance.begin() + static_cast<std::ptrdiff_t>(signed_distance.size() / 2),
      signed_distance.end());
  EXPECT_LT(std::abs(signed_distance[signed_distance.size() / 2]), 0.05e-3);
  std::nth_element(distance.begin(),
                   distance.begin() + static_cast<std::ptrdiff_t>(distance.size() * 9 / 10),
                   distance.end());
  EXPECT_LT(distance[distance.size() * 9 / 10], 0.4e-3);
}

}  // namespace
}  // namespace glidar
