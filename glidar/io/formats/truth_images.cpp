// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/truth_images.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/pictures/picture.hpp>
#include <glidar/math/portable.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace glidar {
namespace {

constexpr std::uint32_t kMaxGrey = std::numeric_limits<std::uint16_t>::max();

template <class T>
const std::vector<T>& field_values(const PointCloud& cloud, const char* column) {
  return std::get<std::vector<T>>(find_column(cloud, column)->values);
}

template <class T>
const std::vector<T>& field_values(const CloudFile& job, const char* column) {
  return field_values<T>(job.cloud, column);
}

template <class T>
void write_pixels(const CloudFile& job, PngKind kind, const std::vector<T>& pixels,
                  AtomicFile& file) {
  write_png({kind, job.cloud.cols, job.cloud.rows, std::as_bytes(std::span(pixels)), job.pixels},
            file);
}

/// The nearest integer to a fraction of `full`, 0 for NaN.
template <class T>
T scaled(double share, double full) {
  return static_cast<T>(std::round(full * std::max(0.0, std::min(1.0, share))));
}

/// Ids as grey, 0 for no id.
template <class Grey>
std::vector<Grey> greys_of(const std::vector<std::uint32_t>& ids) {
  std::vector<Grey> greys(ids.size());
  std::transform(ids.begin(), ids.end(), greys.begin(), [](std::uint32_t id) {
    return id == kInvalidId ? Grey{0} : static_cast<Grey>(id);
  });
  return greys;
}

void write_rgb_png(const CloudFile& job, AtomicFile& file) {
  write_pixels(job, PngKind::rgb8, rgb_pixels(job.cloud), file);
}

/// 16-bit RGB: the triangle's unit normal in the cloud's frame, n = 2 v / 65535 - 1.
void write_normal_png(const CloudFile& job, AtomicFile& file) {
  const auto& normals = field_values<float>(job, "normal");
  std::vector<std::uint16_t> pixels(normals.size());
  std::transform(normals.begin(), normals.end(), pixels.begin(), [](float part) {
    return std::isnan(part) ? std::uint16_t{0} : scaled<std::uint16_t>(0.5 + 0.5 * part, kMaxGrey);
  });
  write_pixels(job, PngKind::rgb16, pixels, file);
}

/// 16-bit grey: ids of instances.
void write_instance_png(const CloudFile& job, AtomicFile& file) {
  const auto& ids = field_values<std::uint32_t>(job, "instance");
  for (const std::uint32_t id : ids) {
    if (id == kInvalidId || (id > 0 && id <= kMaxGrey)) continue;
    throw Error({file.path().string(),
                 id == 0 ? "an instance has the id 0, which means no surface in this file"
                         : fmt::format("the instance id {} does not fit 16 bits", id),
                 "ids from 1 to 65535",
                 "set 'id' of the model in the scene file, or write a cloud with the column "
                 "instance"});
  }
  write_pixels(job, PngKind::grey16, greys_of<std::uint16_t>(ids), file);
}

/// 8-bit grey, for scenes with more than 256 classes 16-bit grey: ids of classes.
void write_class_png(const CloudFile& job, AtomicFile& file) {
  constexpr std::size_t kMaxSmall = 256;
  const auto& ids = field_values<std::uint32_t>(job, "class");
  const std::size_t classes = job.context.scene.class_names.size();
  if (classes <= kMaxSmall) {
    write_pixels(job, PngKind::grey8, greys_of<std::uint8_t>(ids), file);
    return;
  }
  if (classes > std::size_t{kMaxGrey} + 1) {
    throw Error({file.path().string(), fmt::format("a scene of {} classes", classes),
                 "up to 65536 classes, which fit 16 bits", "write a cloud with the column class"});
  }
  write_pixels(job, PngKind::grey16, greys_of<std::uint16_t>(ids), file);
}

}  // namespace

std::vector<std::uint8_t> rgb_pixels(const PointCloud& cloud) {
  const auto& colours = field_values<float>(cloud, "colour");
  const auto& incidences = field_values<float>(cloud, "incidence");
  std::vector<std::uint8_t> pixels(colours.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double light = portable_cos(double{incidences[i / 3]});  // NaN for no surface
    pixels[i] = std::isnan(light) ? 0 : scaled<std::uint8_t>(colours[i] * light, 255.0);
  }
  return pixels;
}

Format rgb_png_format() {
  return {.info = {.suffix = ".rgb.png",
                   .description = "surface colour, lit at the sensor",
                   .columns = {"colour", "incidence"}},
          .content = Content::image,
          .write = write_rgb_png,
          .pixels =
              "surface colour times cosine of incidence times 255 as 8-bit RGB; black: no surface"};
}

Format normal_png_format() {
  return {.info = {.suffix = ".normal.png", .description = "16-bit normals", .columns = {"normal"}},
          .content = Content::image,
          .write = write_normal_png,
          .pixels =
              "unit normal n in frame_id as 16-bit RGB v: n = 2 v / 65535 - 1; 0 0 0: no surface"};
}

Format instance_png_format() {
  return {.info = {.suffix = ".instance.png",
                   .description = "16-bit instance ids",
                   .columns = {"instance"}},
          .content = Content::image,
          .write = write_instance_png,
          .pixels = "id of the instance as 16-bit grey; 0: no surface"};
}

Format class_png_format() {
  return {.info = {.suffix = ".class.png", .description = "class ids", .columns = {"class"}},
          .content = Content::image,
          .write = write_class_png,
          .pixels = "id of the class as grey; 0: unlabelled, or no surface"};
}

}  // namespace glidar
