// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/format.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/pictures/picture.hpp>
#include <glidar/math/portable.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace glidar {
namespace {

constexpr double kMaxDepthGrey = std::numeric_limits<std::uint16_t>::max();

/// The maximum scale for this depth, rounded down to two digits.
double fitting_scale(double depth_m) {
  const double exact = kMaxDepthGrey / depth_m;
  const double unit = power_of_ten(decimal_exponent(exact) - 1);
  return std::floor(exact / unit) * unit;
}

void check_distances(const Column& column, double units_per_m, const AtomicFile& file) {
  const auto& depths_m = std::get<std::vector<double>>(column.values);
  double max_m = 0.0;
  double smallest_m = 0.0;
  for (const double depth_m : depths_m) {
    if (depth_m > max_m) max_m = depth_m;
    if (depth_m < smallest_m) smallest_m = depth_m;
  }
  if (smallest_m < 0.0) {
    throw Error({file.path().string(),
                 fmt::format("a depth of {:.9g} m, behind the sensor", smallest_m),
                 "depths above 0", "write .npy or .depth.tiff, which can store any depth"});
  }
  if (std::round(max_m * units_per_m) > kMaxDepthGrey) {
    throw Error(
        {file.path().string(),
         fmt::format("the largest {}, {:.9g} m, does not fit 16 bits at {:.9g} units per "
                     "metre",
                     column.name, max_m, units_per_m),
         fmt::format("up to {:.9g} m", kMaxDepthGrey / units_per_m),
         fmt::format("use {:.9g} units per metre (--depth-scale, depth_units_per_m in Python), or "
                     "write .{}.npy",
                     fitting_scale(max_m), column.name)});
  }
}

/// Writes a 16-bit grey image: depth times options.depth_png_units_per_m, rounded to a number
/// within the sensor's limits, at least 1; 0: no return. Throws Error when a depth is behind the
/// sensor or above 65535 units.
void write_distances(const CloudFile& job, const Column& column, Limits::Along along,
                     AtomicFile& file) {
  const auto& depths_m = std::get<std::vector<double>>(column.values);
  const double units_per_m = job.options.depth_png_units_per_m;
  const Limits& limits = job.context.sensor.limits;
  check_distances(column, units_per_m, file);
  std::vector<std::uint16_t> grey(depths_m.size());
  std::transform(depths_m.begin(), depths_m.end(), grey.begin(), [&](double depth_m) {
    if (std::isnan(depth_m)) return std::uint16_t{0};
    // 0 means no return, so a surface nearer than half a unit counts as one unit
    return static_cast<std::uint16_t>(
        std::max(1.0, to_whole_units(limits, along, depth_m, 1.0 / units_per_m)));
  });
  write_png({PngKind::grey16, job.cloud.cols, job.cloud.rows, std::as_bytes(std::span(grey)),
             fmt::format("{}, {:.17g} units per metre, 0: no return", column.name, units_per_m)},
            file);
}

void write_depth_png(const CloudFile& job, AtomicFile& file) {
  write_distances(job, distance_column(job.cloud), Limits::Along::depth, file);
}

void write_range_png(const CloudFile& job, AtomicFile& file) {
  write_distances(job, *find_column(job.cloud, "range"), Limits::Along::range, file);
}

bool looks_back(const Beams& beams) {
  return std::any_of(beams.directions.begin(), beams.directions.end(),
                     [&](const auto& direction) { return direction.dot(beams.boresight) < 0.0; });
}

Misfit depth_png_misfit(const CloudPictureOptions& /*picture*/, const Sensor& sensor,
                        const Beams& beams) {
  if (std::holds_alternative<Pinhole>(sensor.optics) || !looks_back(beams)) return {};
  return {"it has beams that point back, where depths are negative",
          "write .range.png, or .depth.tiff, which holds any depth"};
}

}  // namespace

Format depth_png_format() {
  return {
      .info = {.suffix = ".depth.png", .description = "16-bit depth image", .columns = {"depth"}},
      .content = Content::image,
      .write = write_depth_png,
      .pixels = "depth times units_per_m as 16-bit grey; 0: no return",
      .misfit = depth_png_misfit};
}

Format range_png_format() {
  return {
      .info = {.suffix = ".range.png", .description = "16-bit range image", .columns = {"range"}},
      .content = Content::image,
      .write = write_range_png,
      .pixels = "range along the beam times units_per_m as 16-bit grey; 0: no return"};
}

}  // namespace glidar
