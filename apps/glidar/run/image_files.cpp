// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/image_files.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/formats/grey_image_file.hpp>
#include <glidar/io/pictures/png_image.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <set>
#include <utility>
#include <vector>

namespace glidar::app {

namespace {

constexpr double kMaxPngNumber = 65535.0;

}  // namespace

void write_multiples_png(std::span<const float> values, double unit, const std::string& description,
                         ImageSize size, AtomicFile& file) {
  std::vector<std::uint16_t> pixels;
  pixels.reserve(values.size());
  for (const float value : values) {
    const double number = std::round(static_cast<double>(value) / unit);
    const bool fits = number > 0.0 && number <= kMaxPngNumber;
    pixels.push_back(fits ? static_cast<std::uint16_t>(number) : std::uint16_t{0});
  }
  write_png(
      {PngKind::grey16, size.width, size.height, std::as_bytes(std::span(pixels)), description},
      file);
}

void write_status_png(std::span<const std::uint8_t> numbers, std::span<const Colour> colours,
                      ImageSize size, AtomicFile& file) {
  Picture picture = make_picture(size.width, size.height, Colour{});
  for (std::size_t i = 0; i < numbers.size(); ++i) picture.pixels[i] = colours[numbers[i]];
  write_png(picture, "status of each pixel", file);
}

namespace {

namespace fs = std::filesystem;

DepthImage load_depth_image(const std::string& path) {
  GreyImage grey = load_grey_image(path);
  if (grey.max_level != std::numeric_limits<std::uint16_t>::max()) {
    throw Error({path, "a PNG of 8 bits", "a depth image of 16 bits, 0 for none",
                 "write depths with 'glidar render -o NAME.depth.png', for example"});
  }
  return {grey.width, grey.height, std::move(grey.level)};
}

bool writes_folder(const DepthImageFiles& files) {
  std::error_code error;
  return files.images.size() > 1 || files.output.ends_with('/') ||
         fs::is_directory(files.output, error);
}

/// The output of each image.
std::vector<std::string> output_names(const DepthImageFiles& files) {
  if (!writes_folder(files)) return {files.output};
  std::vector<std::string> names;
  std::set<std::string> known;
  for (const std::string& image : files.images) {
    const fs::path name = fs::path(files.output) / fs::path(image).filename();
    if (!known.insert(name.string()).second) {
      throw Error({"--output " + files.output,
                   "two images have the name " + name.filename().string(),
                   "images with different names", "take the images of each folder by themselves"});
    }
    names.push_back(name.string());
  }
  return names;
}

std::size_t count_depths(const DepthImage& image) {
  const auto holes = std::count(image.depth.begin(), image.depth.end(), std::uint16_t{0});
  return image.depth.size() - static_cast<std::size_t>(holes);
}

void write_depth_image(const DepthImage& image, double unit_mm, AtomicFile& file) {
  write_png({PngKind::grey16, image.width, image.height, std::as_bytes(std::span(image.depth)),
             "depth in units of " + number_text(unit_mm) + " mm, 0: none"},
            file);
  file.finish();
}

double percent(std::size_t part, std::size_t whole) {
  return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

DepthImageSummary change_depth_images(const DepthImageFiles& files,
                                      const std::function<DepthImage(const DepthImage&)>& change) {
  if (files.output.empty()) {
    throw Error({"--output", "there is no -o, so nothing would be written", "",
                 "add -o changed.png, for example"});
  }
  DepthImageSummary summary;
  summary.files = output_names(files);
  std::vector<std::string> read = files.images;
  if (!files.settings.empty()) read.push_back(files.settings);
  StagedFiles staged;
  staged.protect(read);
  if (writes_folder(files)) staged.add_folder(files.output);
  for (std::size_t i = 0; i < files.images.size(); ++i) {
    const DepthImage image = load_depth_image(files.images[i]);
    const DepthImage changed = change(image);
    write_depth_image(changed, files.unit_mm, staged.add(summary.files[i]));
    summary.pixels += image.depth.size();
    summary.pixels_with_depth += count_depths(image);
    summary.written_pixels += changed.depth.size();
    summary.written_pixels_with_depth += count_depths(changed);
  }
  staged.commit();
  return summary;
}

std::string summary_text(const DepthImageSummary& summary, const std::string& after) {
  std::string text = fmt::format("{:.1f} % of pixels with depth, {:.1f} % after {}\nwrote {}",
                                 percent(summary.pixels_with_depth, summary.pixels),
                                 percent(summary.written_pixels_with_depth, summary.written_pixels),
                                 after, summary.files.front());
  if (summary.files.size() > 1) {
    text += fmt::format(" to {} ({} files)", summary.files.back(), summary.files.size());
  }
  return text + "\n";
}

}  // namespace glidar::app
