// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/image_message.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/config/camera_info.hpp>
#include <glidar/io/pictures/png_image.hpp>
#include <glidar/math/constants.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace glidar::ros {
namespace {

Header frame_header(const CloudSource& source, const std::string& frame_id) {
  return {.stamp = time_from_ns(first_firing_ns(source.frame, source.beams)),
          .frame_id = frame_id.empty() ? source.frame.frame_id : frame_id};
}

/// An image of the first return of all beams; `pixel` gives the number of a beam.
template <class Number, class Pixel>
Image image_of(const CloudSource& source, const std::string& encoding, const Pixel& pixel) {
  const Beams& beams = source.beams;
  Image image;
  image.height = beams.rows / beams.returns;
  image.width = beams.cols;
  image.encoding = encoding;
  image.step = image.width * static_cast<std::uint32_t>(sizeof(Number));
  std::vector<Number> pixels(beams.firings());
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = pixel(i);
  const auto bytes = std::as_bytes(std::span(pixels));
  image.data = Payload(std::vector<std::byte>(bytes.begin(), bytes.end()));
  return image;
}

double measured_depth_m(const CloudSource& source, std::size_t beam) {
  const double range_m = source.frame.range_m[beam];
  if (source.frame.status[beam] != Status::hit || std::isnan(range_m)) return kNaN;
  const double depth = depth_m(source.beams, beam, range_m);
  if (depth >= 0.0) return depth;
  throw Error({"depth image", fmt::format("a depth of {:.9g} m, behind the sensor", depth),
               "depths of 0 or more", "publish a cloud instead"});
}

std::uint16_t millimetres_of(double depth) {
  constexpr double kMax = std::numeric_limits<std::uint16_t>::max();
  const double millimetres = std::round(depth * 1e3);
  return millimetres <= kMax ? static_cast<std::uint16_t>(std::max(1.0, millimetres)) : 0;
}

/// The PNG file of an image of encoding mono8 or 16UC1.
std::vector<std::byte> png_of(const Image& image) {
  const bool is_wide = image.encoding == "16UC1";
  if (!is_wide && image.encoding != "mono8") {
    throw Error({"CompressedImage", "an image of encoding " + image.encoding, "mono8 or 16UC1"});
  }
  const std::vector<std::byte> pixels = image.data.to_vector();
  const std::size_t row = std::size_t{image.width} * (is_wide ? 2U : 1U);
  if (image.step != row || pixels.size() != row * image.height)
    throw Error({"CompressedImage", "rows with padding", "rows that follow each other"});
  const PngKind kind = is_wide ? PngKind::grey16 : PngKind::grey8;
  return encode_png({kind, image.width, image.height, pixels, {}});
}

}  // namespace

Image depth_image(const CloudSource& source, DepthEncoding encoding, const std::string& frame_id) {
  if (source.beams.returns > 1) {
    throw Error({"depth image", fmt::format("{} returns of each beam", source.beams.returns),
                 "one return", "use --returns strongest"});
  }
  const auto depth = [&](std::size_t beam) { return measured_depth_m(source, beam); };
  const auto in_mm = [&](std::size_t beam) { return millimetres_of(depth(beam)); };
  const auto in_m = [&](std::size_t beam) { return static_cast<float>(depth(beam)); };
  Image image = encoding == DepthEncoding::metres_32fc1
                    ? image_of<float>(source, "32FC1", in_m)
                    : image_of<std::uint16_t>(source, "16UC1", in_mm);
  image.header = frame_header(source, frame_id);
  return image;
}

Image intensity_image(const CloudSource& source, IntensityEncoding encoding,
                      const std::string& frame_id) {
  const auto& intensity = source.frame.intensity;
  const auto byte = [&](std::size_t beam) {
    return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(intensity[beam], 0.0F, 1.0F)));
  };
  const auto number = [&](std::size_t beam) { return intensity[beam]; };
  Image image = encoding == IntensityEncoding::f32c1
                    ? image_of<float>(source, "32FC1", number)
                    : image_of<std::uint8_t>(source, "mono8", byte);
  image.header = frame_header(source, frame_id);
  return image;
}

Image range_image(const CloudSource& source, const std::string& frame_id) {
  const auto range = [&](std::size_t beam) {
    if (source.frame.status[beam] != Status::hit) return std::numeric_limits<float>::quiet_NaN();
    return static_cast<float>(source.frame.range_m[beam] + source.beams.range_offset_m);
  };
  Image image = image_of<float>(source, "32FC1", range);
  image.header = frame_header(source, frame_id);
  return image;
}

CompressedImage png_image(const Image& image) {
  return {image.header, image.encoding + "; png compressed ", Payload(png_of(image))};
}

/// compressed_depth_image_transport/compression_common.h: an int32 for the format, of which there
/// is one, 0, and two float32, which images of whole millimetres do not use.
CompressedImage compressed_depth_image(const Image& image) {
  constexpr std::size_t kHeader_bytes = 12;
  if (image.encoding != "16UC1") {
    throw Error({"compressedDepth", "an image of encoding " + image.encoding, "16UC1"});
  }
  std::vector<std::byte> bytes(kHeader_bytes);
  const std::vector<std::byte> png = png_of(image);
  bytes.insert(bytes.end(), png.begin(), png.end());
  return {image.header, "16UC1; compressedDepth png", Payload(std::move(bytes))};
}

CameraInfo camera_info(const CloudSource& source, const std::string& frame_id) {
  std::optional<CameraModel> model = camera_model(source.sensor.optics);
  if (!model) {
    throw Error({"CameraInfo", "the sensor is no camera", "pinhole optics",
                 "publish CameraInfo for cameras only"});
  }
  CameraInfo info;
  info.header = frame_header(source, frame_id);
  info.height = model->height;
  info.width = model->width;
  info.distortion_model = std::move(model->distortion_model);
  info.d = std::move(model->d);
  info.k = model->k;
  info.r = model->r;
  info.p = model->p;
  return info;
}

}  // namespace glidar::ros
