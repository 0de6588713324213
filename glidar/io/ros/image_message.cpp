// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/sensor_topics.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/config/camera_info.hpp>
#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/io/pictures/picture.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/portable.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>

namespace glidar::ros {
namespace {

Header frame_header(const CloudSource& source, const std::string& frame_id) {
  return {.stamp = time_from_ns(first_firing_ns(source.frame, source.beams)),
          .frame_id = frame_id.empty() ? source.frame.frame_id : frame_id};
}

/// An image of the first return of all beams; `pixel` gives the number of a beam.
template <class Number, class Pixel>
Image image_of(const CloudSource& source, const std::string& encoding, const std::string& frame_id,
               const Pixel& pixel) {
  const Beams& beams = source.beams;
  Image image;
  image.header = frame_header(source, frame_id);
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

double measured_depth_m(const CloudSource& source, bool has_ranges, std::size_t beam) {
  const double range_m = source.frame.range_m[beam];
  if (source.frame.status[beam] != Status::hit || std::isnan(range_m)) return kNaN;
  if (has_ranges) return range_m + source.beams.range_offset_m;
  const double depth = depth_m(source.beams, beam, range_m);
  if (depth >= 0.0) return depth;
  throw Error({"depth image", fmt::format("a depth of {:.9g} m, behind the sensor", depth),
               "depths of 0 or more", "publish a cloud instead"});
}

std::uint16_t millimetres_of(const Limits& limits, double depth) {
  constexpr double kMax = std::numeric_limits<std::uint16_t>::max();
  const double millimetres = to_whole_units(limits, Limits::Along::depth, depth, 1e-3);
  return millimetres <= kMax ? static_cast<std::uint16_t>(std::max(1.0, millimetres)) : 0;
}

/// Scales values so that the 10th and 90th percentile of those above 0 are at 0.1 and 0.9.
void expose(std::vector<float>& values) {
  constexpr float kShare = 0.1F;
  std::vector<float> lit;
  std::copy_if(values.begin(), values.end(), std::back_inserter(lit),
               [](float value) { return value > 0.0F; });
  if (lit.empty()) return;
  const auto percentile = [&](float share) {
    const auto place =
        lit.begin() + static_cast<std::ptrdiff_t>(share * static_cast<float>(lit.size() - 1));
    std::nth_element(lit.begin(), place, lit.end());
    return *place;
  };
  const float low = percentile(kShare);
  const float high = std::max(percentile(1.0F - kShare), low * (1.0F + kShare));
  for (float& value : values) {
    const float scaled = kShare + (1.0F - 2.0F * kShare) * (value - low) / (high - low);
    value = value > 0.0F ? std::clamp(scaled, 0.0F, 1.0F) : 0.0F;
  }
}

/// The numbers of the pixels of Ouster's images, before rows are shifted: from 0 to 65535.
std::vector<float> ouster_values(const CloudSource& source, OusterChannel channel) {
  const auto& [frame, sensor, beams] = source;
  std::vector<float> values(beams.firings(), 0.0F);
  if (channel == OusterChannel::near_infrared) return values;  // sunlight is not simulated
  constexpr float kMax = 65535.0F;
  if (channel == OusterChannel::range) {
    constexpr double kStep_mm = 4.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double mm = std::round((frame.range_m[i] + beams.range_offset_m) * 1e3);
      const auto steps = static_cast<float>(std::floor((mm + 2.0) / kStep_mm));
      values[i] = steps <= kMax ? steps : 0.0F;  // NaN too
    }
    return values;
  }
  if (channel == OusterChannel::signal) {
    values.assign(frame.intensity.begin(),
                  frame.intensity.begin() + static_cast<std::ptrdiff_t>(values.size()));
  } else {
    PointCloud cloud{beams.rows, beams.cols, {}, Pose::Identity(), {}};
    cloud.columns = {{"intensity", {"intensity"}, frame.intensity},
                     {"range", {"range"}, frame.range_m}};
    const std::vector<float> shares = unit_intensities(cloud, sensor, beams);
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = std::isnan(frame.range_m[i]) ? 0.0F : shares[i];
  }
  expose(values);
  const bool is_signal = channel == OusterChannel::signal;
  for (float& value : values) value = kMax * (is_signal ? std::sqrt(value) : value);
  return values;
}

/// The PNG file of an image of encoding mono8, 16UC1 or rgb8.
std::vector<std::byte> png_of(const Image& image) {
  struct Kind {
    std::string_view encoding;
    PngKind kind;
    std::size_t bytes;
  };
  constexpr std::array<Kind, 3> kKinds = {
      {{"mono8", PngKind::grey8, 1}, {"16UC1", PngKind::grey16, 2}, {"rgb8", PngKind::rgb8, 3}}};
  const auto* kind = std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& known) {
    return known.encoding == image.encoding;
  });
  if (kind == kKinds.end()) {
    throw Error(
        {"CompressedImage", "an image of encoding " + image.encoding, "mono8 or 16UC1 or rgb8"});
  }
  const std::vector<std::byte> pixels = image.data.to_vector();
  const std::size_t row = image.width * kind->bytes;
  if (image.step != row || pixels.size() != row * image.height)
    throw Error({"CompressedImage", "rows with padding", "rows that follow each other"});
  return encode_png({kind->kind, image.width, image.height, pixels, {}});
}

}  // namespace

Image depth_image(const CloudSource& source, DepthEncoding encoding, const std::string& frame_id) {
  if (source.beams.returns > 1) {
    throw Error({"depth image", fmt::format("{} returns of each beam", source.beams.returns),
                 "one return", "use --returns strongest"});
  }
  const bool has_ranges = images_have_range(source.sensor, source.beams);
  const auto depth = [&](std::size_t beam) { return measured_depth_m(source, has_ranges, beam); };
  const auto in_mm = [&](std::size_t beam) {
    return millimetres_of(source.sensor.limits, depth(beam));
  };
  const auto in_m = [&](std::size_t beam) { return static_cast<float>(depth(beam)); };
  return encoding == DepthEncoding::metres_32fc1
             ? image_of<float>(source, "32FC1", frame_id, in_m)
             : image_of<std::uint16_t>(source, "16UC1", frame_id, in_mm);
}

Image intensity_image(const CloudSource& source, IntensityEncoding encoding,
                      const std::string& frame_id) {
  const auto& intensity = source.frame.intensity;
  const auto share = [&](std::size_t beam) { return std::clamp(intensity[beam], 0.0F, 1.0F); };
  if (encoding == IntensityEncoding::f32c1)
    return image_of<float>(source, "32FC1", frame_id, [&](std::size_t i) { return intensity[i]; });
  if (encoding == IntensityEncoding::mono16)
    return image_of<std::uint16_t>(source, "mono16", frame_id, [&](std::size_t beam) {
      return static_cast<std::uint16_t>(std::lround(65535.0F * share(beam)));
    });
  return image_of<std::uint8_t>(source, "mono8", frame_id, [&](std::size_t beam) {
    return static_cast<std::uint8_t>(std::lround(255.0F * share(beam)));
  });
}

Image range_image(const CloudSource& source, const std::string& frame_id) {
  return image_of<float>(source, "32FC1", frame_id, [&](std::size_t beam) {
    if (source.frame.status[beam] != Status::hit) return std::numeric_limits<float>::quiet_NaN();
    return static_cast<float>(source.frame.range_m[beam] + source.beams.range_offset_m);
  });
}

Image colour_image(const CloudSource& source, ColourEncoding encoding,
                   const std::string& frame_id) {
  const auto& colours = source.frame.ground_truth.colour;
  if (colours.size() != source.beams.size())
    throw Error({"colour image", "the frame has no colours", "", "request the column colour"});
  const auto byte = [&](std::size_t beam, int channel) {
    const float value = colours[beam][channel];  // NaN without a surface
    return static_cast<std::uint8_t>(std::lround(255.0F * std::min(std::max(0.0F, value), 1.0F)));
  };
  if (encoding == ColourEncoding::rgb8) {
    return image_of<std::array<std::uint8_t, 3>>(source, "rgb8", frame_id, [&](std::size_t i) {
      return std::array<std::uint8_t, 3>{byte(i, 0), byte(i, 1), byte(i, 2)};
    });
  }
  return image_of<std::array<std::uint8_t, 4>>(source, "bgra8", frame_id, [&](std::size_t i) {
    return std::array<std::uint8_t, 4>{byte(i, 2), byte(i, 1), byte(i, 0), 255};
  });
}

Image raw_image(const CloudSource& source, std::string_view name, const std::string& frame_id) {
  for (const RawImage& raw : source.frame.raw_images) {
    if (raw.name != name) continue;
    const std::vector<std::uint16_t>& level = raw.grey.level;
    if (raw.grey.max_level > std::numeric_limits<std::uint8_t>::max())
      return image_of<std::uint16_t>(source, "mono16", frame_id,
                                     [&](std::size_t i) { return level[i]; });
    return image_of<std::uint8_t>(source, "mono8", frame_id, [&](std::size_t i) {
      return static_cast<std::uint8_t>(level[i]);
    });
  }
  throw Error({"infrared image", fmt::format("the frame has no image {}", name), "",
               "use --depth-model physical"});
}

Image ouster_image(const CloudSource& source, OusterChannel channel, const std::string& frame_id) {
  const Beams& beams = source.beams;
  const std::vector<std::size_t> shifts = row_shifts(source.sensor, beams);
  std::vector<float> values(beams.firings(), 0.0F);
  const std::vector<float> shown = ouster_values(source, channel);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t row = i / beams.cols;
    const std::size_t col = (i % beams.cols + beams.cols - shifts[row]) % beams.cols;
    values[i] = shown[row * beams.cols + col];
  }
  return image_of<std::uint16_t>(source, "mono16", frame_id, [&](std::size_t i) {
    return static_cast<std::uint16_t>(values[i]);
  });
}

CompressedImage png_image(const Image& image) {
  // the plugin converts colours to OpenCV's order before it encodes them
  const std::string target = image.encoding == "rgb8" ? "bgr8" : "";
  return {image.header, image.encoding + "; png compressed " + target, Payload(png_of(image))};
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

CameraInfo camera_info(const CloudSource& source, const std::string& frame_id,
                       double right_baseline_m) {
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
  info.p[3] = right_baseline_m == 0.0 ? 0.0 : -info.p[0] * right_baseline_m;
  return info;
}

namespace {

constexpr double kWholeTurn = 2.0 * std::numbers::pi;

/// A beam of the scan.
struct ScanBeam {
  std::size_t index = 0;
  double angle_rad = 0.0;  ///< continuous: without a jump at +-pi
};

std::uint32_t time_of(const Beams& beams, std::size_t beam) {
  return beams.times_ns.empty() ? 0 : beams.times_ns[beam];
}

/// The beams of a ring in the order in which they fire.
std::vector<ScanBeam> beams_of(const Beams& beams, std::uint16_t ring, int quarter_turns) {
  SensorAxes axes = axes_of(beams);
  for (int i = 0; i < quarter_turns; ++i)
    axes = {.ahead = -axes.left, .left = axes.ahead, .up = axes.up};
  std::vector<ScanBeam> scan;
  for (std::size_t i = 0; i < beams.firings(); ++i) {
    if (ring_of(beams, i) != ring || std::isnan(beams.directions[i].x())) continue;
    scan.push_back({i, azimuth_rad(axes, beams.directions[i])});
  }
  std::stable_sort(scan.begin(), scan.end(), [&](const ScanBeam& a, const ScanBeam& b) {
    return time_of(beams, a.index) < time_of(beams, b.index);
  });
  for (std::size_t i = 1; i < scan.size(); ++i) {
    const double change = scan[i].angle_rad - scan[i - 1].angle_rad;
    scan[i].angle_rad -= kWholeTurn * std::round(change / kWholeTurn);
  }
  return scan;
}

/// The angle between neighbours. Throws Error unless all are equal to a hundredth.
double spacing_of(const std::vector<ScanBeam>& scan, std::uint16_t ring) {
  const std::string where = fmt::format("LaserScan of ring {}", ring);
  if (scan.size() < 2) {
    throw Error({where, fmt::format("{} beams", scan.size()), "at least 2",
                 "select another ring, or publish a cloud"});
  }
  const double spacing =
      (scan.back().angle_rad - scan.front().angle_rad) / static_cast<double>(scan.size() - 1);
  constexpr double kTolerance = 0.01;
  for (std::size_t i = 1; i < scan.size(); ++i) {
    const double angle = scan[i].angle_rad - scan[i - 1].angle_rad;
    if (std::abs(angle - spacing) <= kTolerance * std::abs(spacing)) continue;
    throw Error(
        {where, fmt::format("beams {:.6g} and {:.6g} rad apart", angle, spacing),
         "equal angles between neighbours",
         "let the frame start at an end of the sector (start_azimuth_deg), or publish a cloud"});
  }
  return spacing;
}

float range_of(const CloudSource& source, std::size_t beam) {
  switch (source.frame.status[beam]) {
    case Status::hit: {
      const Beams& beams = source.beams;
      const SensorAxes axes = axes_of(beams);
      Eigen::Vector3d point = source.frame.range_m[beam] * beams.directions[beam];
      if (!beams.origins_m.empty()) point += beams.origins_m[beam];
      return static_cast<float>(portable_hypot(point.dot(axes.ahead), point.dot(axes.left)));
    }
    case Status::too_near:
      return -std::numeric_limits<float>::infinity();
    case Status::miss:
    case Status::too_far:
    case Status::below_threshold:
    case Status::no_return_of_rank:
      return std::numeric_limits<float>::infinity();
    default:
      return kNaNf;
  }
}

/// From -pi to below pi; an angle within `tolerance` below it is -pi.
double wrapped(double angle_rad, double tolerance) {
  const double turns = std::floor((angle_rad + std::numbers::pi + tolerance) / kWholeTurn);
  return angle_rad - kWholeTurn * turns;
}

/// Angles that increase, from -pi on if they are a whole turn.
void sort_by_angle(double spacing, std::vector<ScanBeam>& scan) {
  if (scan.back().angle_rad < scan.front().angle_rad) std::reverse(scan.begin(), scan.end());
  constexpr double kTolerance = 1e-3;
  const double covered = spacing * static_cast<double>(scan.size());
  const bool is_whole_turn = std::abs(covered - kWholeTurn) < spacing;
  if (!is_whole_turn) {
    const double shift = wrapped(scan.front().angle_rad, 0.0) - scan.front().angle_rad;
    for (ScanBeam& beam : scan) beam.angle_rad += shift;
    return;
  }
  for (ScanBeam& beam : scan) beam.angle_rad = wrapped(beam.angle_rad, kTolerance * spacing);
  std::sort(scan.begin(), scan.end(),
            [](const ScanBeam& a, const ScanBeam& b) { return a.angle_rad < b.angle_rad; });
}

LaserScan empty_scan(const CloudSource& source, std::int64_t stamp_ns,
                     const std::string& frame_id) {
  LaserScan message;
  message.header = {.stamp = time_from_ns(stamp_ns),
                    .frame_id = frame_id.empty() ? source.frame.frame_id : frame_id};
  message.scan_time = static_cast<float>(1.0 / source.sensor.rate_hz);
  return message;
}

void set_angles(double min_rad, double max_rad, double increment_rad, LaserScan& message) {
  message.angle_min = static_cast<float>(min_rad);
  message.angle_max = static_cast<float>(max_rad);
  message.angle_increment = static_cast<float>(increment_rad);
}

void fill(std::size_t size, float range, LaserScan& message) {
  message.ranges.assign(size, range);
  message.intensities.assign(size, 0.0F);
}

/// Beams with a return, their level range and their azimuth from -pi to pi.
template <class Use>
void for_returns(const CloudSource& source, std::optional<std::uint16_t> ring, const Use& use) {
  const Beams& beams = source.beams;
  const SensorAxes axes = axes_of(beams);
  for (std::size_t i = 0; i < beams.firings(); ++i) {
    if (source.frame.status[i] != Status::hit || (ring && ring_of(beams, i) != *ring)) continue;
    use(i, range_of(source, i), azimuth_rad(axes, beams.directions[i]));
  }
}

}  // namespace

LaserScan velodyne_scan(const CloudSource& source, std::int64_t stamp_ns,
                        const std::string& frame_id) {
  constexpr double kResolution_rad = 0.007;
  const Beams& beams = source.beams;
  std::uint16_t rings = 0;
  for (std::size_t i = 0; i < beams.firings(); ++i)
    rings = std::max<std::uint16_t>(rings, static_cast<std::uint16_t>(ring_of(beams, i) + 1));
  const std::uint16_t level = rings > 32 ? 57 : rings > 16 ? 23 : 8;
  LaserScan message = empty_scan(source, stamp_ns, frame_id);
  message.scan_time = 0.0F;
  set_angles(-std::numbers::pi, std::numbers::pi, kResolution_rad, message);
  message.range_max = 200.0F;
  const auto size = static_cast<std::size_t>(kWholeTurn / kResolution_rad);
  fill(size, std::numeric_limits<float>::infinity(), message);
  for_returns(source, level, [&](std::size_t beam, float range_m, double angle_rad) {
    const auto bin = static_cast<std::size_t>((angle_rad + std::numbers::pi) / kResolution_rad);
    if (bin >= size) return;
    message.ranges[bin] = range_m;
    message.intensities[bin] = source.frame.intensity[beam];
  });
  return message;
}

LaserScan ouster_scan(const CloudSource& source, std::int64_t stamp_ns,
                      const std::string& frame_id) {
  const Beams& beams = source.beams;
  const std::size_t width = beams.cols;
  const std::size_t shift = row_shifts(source.sensor, beams)[0];
  LaserScan message = empty_scan(source, stamp_ns, frame_id);
  set_angles(-std::numbers::pi, std::numbers::pi, kWholeTurn / static_cast<double>(width), message);
  message.time_increment = message.scan_time / static_cast<float>(width);
  message.range_min = 0.1F;
  message.range_max = 120.0F;
  fill(width, 0.0F, message);
  for (std::size_t v = 0; v < width; ++v) {
    const std::size_t beam = (v + width - shift + width / 2) % width;
    if (source.frame.status[beam] != Status::hit) continue;
    const double millimetres =
        std::round((source.frame.range_m[beam] + beams.range_offset_m) * 1e3);
    message.ranges[width - 1 - v] = static_cast<float>(millimetres * 1e-3);
    message.intensities[width - 1 - v] = source.frame.intensity[beam];
  }
  return message;
}

LaserScan rplidar_scan(const CloudSource& source, std::int64_t stamp_ns,
                       const std::string& frame_id) {
  constexpr double kTurn_deg = 360.0;
  const std::size_t per_degree = source.beams.cols / 360 + 1;
  const std::size_t size = 360 * per_degree;
  LaserScan message = empty_scan(source, stamp_ns, frame_id);
  const auto steps = static_cast<double>(size - 1);
  set_angles(-std::numbers::pi, std::numbers::pi, kWholeTurn / steps, message);
  message.time_increment = message.scan_time / static_cast<float>(steps);
  message.range_min = 0.05F;
  message.range_max = static_cast<float>(source.sensor.limits.far_m);
  fill(size, std::numeric_limits<float>::infinity(), message);
  for_returns(source, std::nullopt, [&](std::size_t beam, float range_m, double angle_rad) {
    // clockwise from the zero of the device
    const double clockwise_deg = angle_rad > 0.0 ? kTurn_deg * (1.0 - angle_rad / kWholeTurn)
                                                 : -kTurn_deg * angle_rad / kWholeTurn;
    const auto bin = static_cast<std::size_t>(clockwise_deg * static_cast<double>(per_degree));
    const float share = std::clamp(source.frame.intensity[beam], 0.0F, 1.0F);
    for (std::size_t i = 0; i < per_degree; ++i) {
      const std::size_t reversed = size - 1 - std::min(bin + i, size - 1);
      message.ranges[reversed] = range_m;
      message.intensities[reversed] = std::floor(255.0F * share / 4.0F);
    }
  });
  return message;
}

LaserScan laser_scan(const CloudSource& source, std::uint16_t ring, const std::string& frame_id,
                     int quarter_turns) {
  std::vector<ScanBeam> scan = beams_of(source.beams, ring, quarter_turns);
  const double spacing = std::abs(spacing_of(scan, ring));
  const auto steps = static_cast<double>(scan.size() - 1);
  const std::uint32_t first_ns = time_of(source.beams, scan.front().index);
  const std::uint32_t last_ns = time_of(source.beams, scan.back().index);
  sort_by_angle(spacing, scan);
  LaserScan message = empty_scan(source, source.frame.stamp_ns + first_ns, frame_id);
  const double angle_min = scan.front().angle_rad;
  set_angles(angle_min, angle_min + spacing * steps, spacing, message);
  message.time_increment =
      static_cast<float>(1e-9 * static_cast<double>(last_ns - first_ns) / steps);
  message.range_min = static_cast<float>(source.sensor.limits.near_m);
  message.range_max = static_cast<float>(source.sensor.limits.far_m);
  for (const ScanBeam& beam : scan) {
    message.ranges.push_back(range_of(source, beam.index));
    message.intensities.push_back(source.frame.intensity[beam.index]);
  }
  return message;
}

}  // namespace glidar::ros
