// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/depth_camera/depth_filters.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/formats/npy_file.hpp>
#include <glidar/io/pictures/picture.hpp>

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace glidar::app {

/// Size of an image.
struct ImageSize {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

/// Whether the name of a file is that of a NumPy array.
inline bool is_npy(const std::string& path) {
  return path.ends_with(".npy");
}

/// Writes a NumPy array rows x columns; `type` is NumPy's, such as "<f4".
template <class T>
void write_image_npy(std::span<const T> values, const char* type, ImageSize size,
                     AtomicFile& file) {
  const std::array<std::size_t, 2> shape = {size.height, size.width};
  file.write(npy_header(type, shape));
  file.write(std::as_bytes(values));
}

/// Writes a 16-bit PNG of multiples of `unit`, 0 for NaN and for those beyond 16 bits.
void write_multiples_png(std::span<const float> values, double unit, const std::string& description,
                         ImageSize size, AtomicFile& file);

/// Writes a PNG of statuses: colours[number].
void write_status_png(std::span<const std::uint8_t> numbers, std::span<const Colour> colours,
                      ImageSize size, AtomicFile& file);

/// Writes the status of each pixel: an array of its numbers, or a PNG of colours[number].
template <class Status>
void write_status_image(const std::string& path, const std::vector<Status>& statuses,
                        std::span<const Colour> colours, ImageSize size, AtomicFile& file) {
  const std::span numbers(reinterpret_cast<const std::uint8_t*>(statuses.data()), statuses.size());
  if (is_npy(path)) return write_image_npy(numbers, "|u1", size, file);
  write_status_png(numbers, colours, size, file);
}

/// "76.2 % valid, 11.3 % border ...": every status that occurs, of `count` that there are.
template <class Status>
std::string status_shares(const std::vector<Status>& statuses, std::size_t count) {
  std::vector<std::size_t> counts(count);
  for (const Status status : statuses) ++counts[static_cast<std::size_t>(status)];
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    if (counts[i] == 0) continue;
    text +=
        fmt::format("{}{:.1f} % {}", text.empty() ? "" : ", ",
                    100.0 * static_cast<double>(counts[i]) / static_cast<double>(statuses.size()),
                    to_string(static_cast<Status>(i)));
  }
  return text;
}

/// Depth images to be changed, and where the results are written: a file for one image; for
/// several, or if it is a folder, a folder for files of the same names.
struct DepthImageFiles {
  std::vector<std::string> images;
  std::string settings = {};  ///< a further file that must not be overwritten; empty: none
  std::string output;
  double unit_mm = 1.0;
};

/// What change_depth_images() did.
struct DepthImageSummary {
  std::size_t pixels = 0;  ///< of all images that were read
  std::size_t pixels_with_depth = 0;
  std::size_t written_pixels = 0;  ///< of all images that were written
  std::size_t written_pixels_with_depth = 0;
  std::vector<std::string> files;
};

/// Reads the images in their order, and writes what `change` returns for each, together. Throws
/// Error: no output, an image that is no PNG of 16 bits, two images of one name.
DepthImageSummary change_depth_images(const DepthImageFiles& files,
                                      const std::function<DepthImage(const DepthImage&)>& change);

/// "95.0 % of pixels with depth, 99.1 % after filtering" and the files, in two lines.
std::string summary_text(const DepthImageSummary& summary, const std::string& after);

}  // namespace glidar::app
