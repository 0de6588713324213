// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/formats/npy_file.hpp>
#include <glidar/io/pictures/picture.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
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

}  // namespace glidar::app
