// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Figure 3 of the 2016 paper: how depths fall into bands when a picture has few steps for them, and
// how tight-fitting planes and more bits improve it. Prints a table of the errors and draws a
// rock's cloud from the side, into the file named (depth_bands.png).
#include <glidar/core/error.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/io/pictures/picture.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/sensor/optics/pinhole.hpp>
#include <glidar/woods2016/framebuffer.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <vector>

namespace {

using glidar::Woods2016Framebuffer;

constexpr int kSkipped = 77;  // CTest's word for "cannot be tested here"
constexpr std::size_t kPanel = 360;

/// Depths as one way of storing them has them; NaN where nothing is seen.
struct Depths {
  const char* how;
  double step_m;
  std::vector<double> depth_m;
};

glidar::Scene make_rock() {
  glidar::Scene scene;
  glidar::add_model(scene, glidar::make_builtin_model("asteroid"));
  return scene;
}

/// The depth if the image had one channel for it: the more significant byte of
/// two is that of 256 steps between the same planes.
Depths one_channel(const Woods2016Framebuffer& picture) {
  const double step_m = (picture.far_m - picture.near_m) / 256.0;
  Depths depths{.how = "8 bits, planes at 0.1 and 20 m", .step_m = step_m, .depth_m = {}};
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
    const bool is_seen = picture.rgba[i + 3] != 0;
    depths.depth_m.push_back(is_seen ? picture.near_m + (picture.rgba[i + 1] + 0.5) * step_m
                                     : std::nan(""));
  }
  return depths;
}

Depths two_channels(const Woods2016Framebuffer& picture, const glidar::Beams& beams) {
  Depths depths{.how = "16 bits, tight-fitting planes",
                .step_m = (picture.far_m - picture.near_m) / 65536.0,
                .depth_m = std::vector<double>(beams.size())};
  std::vector<float> intensity(beams.size());
  glidar::decode_framebuffer(picture, beams, {0, beams.size()}, depths.depth_m, intensity);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    depths.depth_m[i] = glidar::depth_m(beams, i, depths.depth_m[i]);
  }
  return depths;
}

Depths single_precision(const glidar::Hits& drawn) {
  constexpr float kMiddle = 5.0F;  // where the rock is, for the step
  Depths depths{.how = "float target, stored with 32 bits",
                .step_m = std::nextafter(kMiddle, 2.0F * kMiddle) - kMiddle,
                .depth_m = {}};
  for (const double depth : drawn.depth_m) depths.depth_m.push_back(static_cast<float>(depth));
  return depths;
}

/// True away from outlines, where a drawing may give a pixel to what is behind.
bool is_inside(const glidar::Hits& truth, std::size_t cols, std::size_t i) {
  constexpr double kSameSurface_m = 0.01;  // three times what a pixel covers
  if (i < cols || i + cols >= truth.depth_m.size()) return false;
  const double here = truth.depth_m[i];
  const auto near_by = {i - cols, i - 1, i + 1, i + cols};
  return std::all_of(near_by.begin(), near_by.end(), [&](std::size_t j) {
    return std::abs(truth.depth_m[j] - here) < kSameSurface_m;  // false for NaN
  });
}

/// Prints the step and the largest and root-mean-square errors against rays cast in double.
void print_row(const Depths& depths, const glidar::Hits& truth, std::size_t cols) {
  double largest_m = 0.0;
  double squares = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < truth.depth_m.size(); ++i) {
    if (!is_inside(truth, cols, i)) continue;
    const double error_m = std::abs(depths.depth_m[i] - truth.depth_m[i]);
    largest_m = std::max(largest_m, error_m);
    squares += error_m * error_m;
    ++count;
  }
  const double rms_m = std::sqrt(squares / static_cast<double>(count));
  std::printf("| %-33s | %9.3g | %11.3g | %8.3g |\n", depths.how, 1e3 * depths.step_m,
              1e3 * largest_m, 1e3 * rms_m);
}

/// The cloud from the side: depth to the right, what is up for the camera upwards.
void draw_panel(const Depths& depths, const glidar::Beams& beams, std::size_t panel,
                glidar::Picture& picture) {
  constexpr double kPixelsPerMetre = 220.0;
  constexpr double kLeft_m = 4.85;  // the depth at the panel's left border
  for (std::size_t i = 0; i < depths.depth_m.size(); ++i) {
    const Eigen::Vector3d& direction = beams.directions[i];
    const double height_m = -depths.depth_m[i] * direction.y() / direction.z();
    const double x = kPixelsPerMetre * (depths.depth_m[i] - kLeft_m);
    const double y = 0.5 * kPanel - kPixelsPerMetre * height_m;
    if (!(x >= 0.0 && x < kPanel && y >= 0.0 && y < kPanel)) continue;  // NaN goes out too
    const std::size_t pixel =
        static_cast<std::size_t>(y) * picture.width + panel * kPanel + static_cast<std::size_t>(x);
    picture.pixels[pixel] = glidar::viridis(0.5 + 0.4 * height_m);
  }
}

void write(const glidar::Picture& picture, const char* path) {
  glidar::AtomicFile file(path);
  glidar::write_png({.kind = glidar::PngKind::rgb8,
                     .width = static_cast<std::uint32_t>(picture.width),
                     .height = static_cast<std::uint32_t>(picture.height),
                     .pixels = std::as_bytes(std::span(picture.pixels)),
                     .description = "Depth bands, after figure 3 of the GLIDAR paper"},
                    file);
  file.commit();
}

void show_bands(const char* path) {
  const glidar::Scene scene = make_rock();
  const glidar::Beams beams = glidar::make_beams(glidar::pinhole_from_fov(640, 640, 0.4));
  const glidar::CastRequest request{
      .beams = beams,
      .world_from_sensor = glidar::look_at({5.5, 1.5, 1.5}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}),
      .hit_columns = {.depth = true}};
  glidar::Hits truth;
  glidar::Hits drawn;
  glidar::make_renderer(scene, {.kind = "rays"})->cast(request, truth);
  glidar::make_renderer(scene, {.kind = "gpu"})->cast(request, drawn);

  const auto camera = glidar::make_woods2016_camera(scene, {});
  Woods2016Framebuffer picture;
  std::vector<Depths> ways;
  camera->draw(request, {}, glidar::Woods2016DepthPlanes{0.1, 20.0}, picture);
  ways.push_back(one_channel(picture));
  camera->draw(request, {}, {}, picture);
  ways.push_back(two_channels(picture, beams));
  ways.push_back(single_precision(drawn));

  glidar::Picture side = glidar::make_picture(3 * kPanel, kPanel, {16, 16, 18});
  std::puts("| how depth is stored               | step (mm) | worst error |      rms |");
  std::puts("|-----------------------------------|-----------|-------------|----------|");
  for (std::size_t i = 0; i < ways.size(); ++i) {
    print_row(ways[i], truth, beams.cols);
    draw_panel(ways[i], beams, i, side);
  }
  write(side, path);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    glidar::make_woods2016_camera(glidar::Scene{}, {});
  } catch (const glidar::Error& error) {
    std::printf("%s\n", error.what());
    return kSkipped;
  }
  try {
    show_bands(argc > 1 ? argv[1] : "depth_bands.png");
  } catch (const glidar::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
