// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/commands/commands.hpp>
#include <glidar/depth_camera/imager.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/formats/npy_file.hpp>
#include <glidar/io/pictures/picture.hpp>

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidar::app {

// The tools of `glidar depth`, each as in commands.hpp, and what they share.

Command add_stereo(CLI::App& depth);
Command add_structured_light(CLI::App& depth);
Command add_tof(CLI::App& depth);

/// The files that a tool writes, each named after its content, and how it runs.
struct ImageOutputs {
  std::vector<std::string> paths = {};
  double depth_unit_mm = 1.0;                                  ///< of PNG images
  std::optional<std::array<std::uint32_t, 2>> explained = {};  ///< column and row of a pixel
  unsigned threads = 0;
  bool quiet = false;
};

/// The contents that a tool can write, by the ends of names: the first `png` of them also as PNG.
struct ImageContents {
  std::span<const std::string_view> names;
  std::size_t png = 0;
};

/// Adds -o and --depth-unit-mm, under the heading "Output".
void add_output_options(CLI::App& command, const ImageContents& contents, ImageOutputs& outputs);
/// Adds --explain; `help` states what it prints.
void add_explain_option(CLI::App& command, const std::string& help, ImageOutputs& outputs);
/// Adds -j and -q.
void add_run_options(CLI::App& command, ImageOutputs& outputs);

/// The content of "wall_depth.png" is "depth". Throws Error for other names.
std::string_view content_of(const std::string& path, const ImageContents& contents);

/// Throws Error unless every name states its content, and there is one, or what `other` asks for.
void check_outputs(const ImageOutputs& outputs, const ImageContents& contents,
                   const std::string& other, bool has_other);

/// Writes a file; `content` is that of its name.
using WriteImage =
    std::function<void(const std::string& path, std::string_view content, AtomicFile& file)>;

/// Adds all outputs to `files`. Throws Error.
void add_images(const ImageOutputs& outputs, const ImageContents& contents, const WriteImage& write,
                StagedFiles& files);

/// Whether the name of a file is that of a NumPy array.
inline bool is_npy(const std::string& path) {
  return path.ends_with(".npy");
}

/// Writes an array rows x columns of 32-bit floats, or a 16-bit PNG of multiples of `unit`, 0 for
/// NaN and for those beyond 16 bits.
void write_number_image(const std::string& path, std::span<const float> values, double unit,
                        const std::string& description, ImageSize size, AtomicFile& file);

/// Writes the depths or ranges (`kind`) of pixels in metres.
void write_length_image(const std::string& path, std::span<const float> lengths_m,
                        const ImageOutputs& outputs, const char* kind, ImageSize size,
                        AtomicFile& file);

/// Writes the status of each pixel: an array of bytes, or a PNG of colours[number].
void write_status_image(const std::string& path, std::span<const std::uint8_t> numbers,
                        std::span<const Colour> colours, ImageSize size, AtomicFile& file);

template <class Status>
std::span<const std::uint8_t> numbers_of(const std::vector<Status>& statuses) {
  static_assert(sizeof(Status) == 1);
  return {reinterpret_cast<const std::uint8_t*>(statuses.data()), statuses.size()};
}

/// Prints the share of each status that occurs ("320x200 pixels: 76.2 % valid, 23.8 % border"), and
/// the files.
void print_shares(std::span<const std::uint8_t> numbers, std::span<const std::string> names,
                  ImageSize size, const ImageOutputs& outputs);

/// The names of the first `count` statuses.
template <class Status>
std::vector<std::string> status_names(std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) names.emplace_back(to_string(static_cast<Status>(i)));
  return names;
}

}  // namespace glidar::app
