// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/raw_image_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/io/files/npy_head.hpp>
#include <glidar/io/formats/npy_file.hpp>
#include <glidar/io/pictures/picture.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <vector>

namespace glidar {
namespace {

using Reference = ActiveStereo::Reference;

constexpr std::uint32_t kMaxByte = 255;
constexpr const char* kPatternPrefix = "pattern_";
constexpr const char* kPatternRemedy =
    "use a sensor file with a depth_camera of type structured_light and --depth-model physical";
constexpr const char* kRemedy =
    "use a sensor with a depth_camera of type active_stereo and --depth-model physical, such as "
    "D435";

/// The image of this name. Throws Error when the frame does not have it.
const GreyImage& find_image(const Frame& frame, const std::string& name, const AtomicFile& file) {
  std::string names;
  for (const RawImage& image : frame.raw_images) {
    if (image.name == name) return image.grey;
    if (!image.name.starts_with(kPatternPrefix)) {
      names += (names.empty() ? "." : ", .") + image.name + ".png";
    } else if (names.empty()) {
      names = ".patterns.npy";
    }
  }
  const std::string found = "a frame without the raw image '" + name + "'";
  if (!names.empty()) throw Error({file.path().string(), found, names, "write one of these"});
  throw Error({file.path().string(), found,
               "a frame of a depth camera that is simulated from infrared images", kRemedy});
}

std::vector<std::uint8_t> bytes_of(const GreyImage& image) {
  std::vector<std::uint8_t> grey(image.level.size());
  std::transform(image.level.begin(), image.level.end(), grey.begin(),
                 [](std::uint16_t level) { return static_cast<std::uint8_t>(level); });
  return grey;
}

void write_image(const CloudFile& job, const std::string& name, AtomicFile& file) {
  const GreyImage& image = find_image(job.frame, name, file);
  if (image.max_level > kMaxByte) {
    write_png({PngKind::grey16, image.width, image.height, std::as_bytes(std::span(image.level)),
               job.pixels},
              file);
    return;
  }
  const std::vector<std::uint8_t> grey = bytes_of(image);
  write_png({PngKind::grey8, image.width, image.height, std::as_bytes(std::span(grey)), job.pixels},
            file);
}

/// The images of patterns, in their order. Throws Error when the frame has none.
std::vector<const GreyImage*> find_patterns(const Frame& frame, const AtomicFile& file) {
  std::vector<const GreyImage*> patterns;
  for (const RawImage& image : frame.raw_images) {
    if (image.name.starts_with(kPatternPrefix)) patterns.push_back(&image.grey);
  }
  if (!patterns.empty()) return patterns;
  throw Error({file.path().string(), "a frame without images of patterns",
               "a frame of a structured-light camera that is simulated from raw images",
               kPatternRemedy});
}

void write_patterns(const CloudFile& job, AtomicFile& file) {
  const std::vector<const GreyImage*> images = find_patterns(job.frame, file);
  const bool is_byte = images.front()->max_level <= kMaxByte;
  const std::array<std::size_t, 3> shape = {images.size(), job.frame.rows, job.frame.cols};
  file.write(npy_header(is_byte ? "|u1" : "<u2", shape));
  for (const GreyImage* image : images) {
    if (is_byte) {
      file.write(std::as_bytes(std::span<const std::uint8_t>(bytes_of(*image))));
    } else {
      file.write(std::as_bytes(std::span(image->level)));
    }
  }
}

/// Reads levels of one or two bytes. Returns the end of what is read.
const char* read_levels(const char* from, std::size_t number_bytes, std::span<std::uint16_t> to) {
  for (std::uint16_t& level : to) {
    if (number_bytes == 1) {
      level = static_cast<std::uint8_t>(*from);
    } else {
      std::memcpy(&level, from, sizeof(level));
    }
    from += number_bytes;
  }
  return from;
}

/// What a sensor without such images lacks; `is_second`: an image that the left one is matched
/// with.
Misfit find_misfit_of(const Sensor& sensor, bool is_second, Reference reference) {
  const DepthCamera* camera = physical_camera(sensor);
  const auto* stereo = camera != nullptr ? std::get_if<ActiveStereo>(camera) : nullptr;
  if (stereo == nullptr) return {"it is not simulated from infrared images", kRemedy};
  if (!is_second || stereo->reference == reference) return {};
  return {reference == Reference::pattern ? "it has a right imager and no reference picture"
                                          : "it has a reference picture and no right imager",
          "write .ir_left.png"};
}

Misfit left_misfit(const CloudPictureOptions& /*picture*/, const Sensor& sensor,
                   const Beams& /*beams*/) {
  return find_misfit_of(sensor, false, Reference::right_imager);
}

Misfit right_misfit(const CloudPictureOptions& /*picture*/, const Sensor& sensor,
                    const Beams& /*beams*/) {
  return find_misfit_of(sensor, true, Reference::right_imager);
}

Misfit reference_misfit(const CloudPictureOptions& /*picture*/, const Sensor& sensor,
                        const Beams& /*beams*/) {
  return find_misfit_of(sensor, true, Reference::pattern);
}

Misfit pattern_misfit(const CloudPictureOptions& /*picture*/, const Sensor& sensor,
                      const Beams& /*beams*/) {
  const DepthCamera* camera = physical_camera(sensor);
  if (camera != nullptr && std::holds_alternative<StructuredLightCamera>(*camera)) return {};
  return {"it is not simulated from images of patterns", kPatternRemedy};
}

}  // namespace

Format ir_left_png_format() {
  return {
      .info = {.suffix = ".ir_left.png",
               .description = "infrared image of a depth camera's left imager",
               .columns = {}},
      .content = Content::image,
      .write = [](const CloudFile& job, AtomicFile& file) { write_image(job, "ir_left", file); },
      .pixels = "grey level of the left infrared imager",
      .misfit = left_misfit};
}

Format ir_right_png_format() {
  return {
      .info = {.suffix = ".ir_right.png",
               .description = "the same of the right imager",
               .columns = {}},
      .content = Content::image,
      .write = [](const CloudFile& job, AtomicFile& file) { write_image(job, "ir_right", file); },
      .pixels = "grey level of the right infrared imager",
      .misfit = right_misfit};
}

Format ir_reference_png_format() {
  return {.info = {.suffix = ".ir_reference.png",
                   .description = "the stored pattern that its image is matched with",
                   .columns = {}},
          .content = Content::image,
          .write = [](const CloudFile& job,
                      AtomicFile& file) { write_image(job, "ir_reference", file); },
          .pixels = "grey level of the pattern as seen from the projector",
          .misfit = reference_misfit};
}

Format patterns_npy_format() {
  return {.info = {.suffix = ".patterns.npy",
                   .description = "raw images of a structured-light camera",
                   .columns = {}},
          .content = Content::image,
          .write = write_patterns,
          .pixels = "grey levels, images x rows x columns",
          .misfit = pattern_misfit};
}

std::vector<GreyImage> load_pattern_images(const std::filesystem::path& path) {
  constexpr std::size_t kMaxImages = 1024;  // more than the sequences of any patterns
  static const InputFileKind kKind = {"an NPY array of images", 1024, ""};
  const std::string bytes = read_input_file(path, kKind);
  const NpyHead head = read_npy_head(path.string(), bytes, NpyNumbers::grey_levels);
  const std::vector<std::size_t>& shape = head.shape;
  if (shape.size() != 3 || shape[0] > kMaxImages ||
      std::find(shape.begin(), shape.end(), 0U) != shape.end()) {
    throw Error({path.string(), "an array of another shape",
                 "images x rows x columns, at most 1024 images",
                 "numpy.stack the images in the order of the patterns"});
  }
  require_npy_numbers(path.string(), head, bytes);
  const char* at = bytes.data() + head.data_at;
  std::vector<GreyImage> images(shape[0]);
  for (GreyImage& image : images) {
    image = {static_cast<std::uint32_t>(shape[2]), static_cast<std::uint32_t>(shape[1]),
             head.number_bytes == 1 ? kMaxByte : std::numeric_limits<std::uint16_t>::max()};
    image.level.resize(shape[1] * shape[2]);
    at = read_levels(at, head.number_bytes, image.level);
  }
  return images;
}

}  // namespace glidar
