// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/raw_image_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/pictures/png_image.hpp>

#include <algorithm>
#include <vector>

namespace glidar {
namespace {

using Reference = ActiveStereo::Reference;

constexpr const char* kRemedy =
    "use a sensor with a depth_camera of type active_stereo and --depth-model physical, such as "
    "D435";

/// The image of this name. Throws Error when the frame does not have it.
const GreyImage& find_image(const Frame& frame, const std::string& name, const AtomicFile& file) {
  std::string names;
  for (const RawImage& image : frame.raw_images) {
    if (image.name == name) return image.grey;
    names += (names.empty() ? "." : ", .") + image.name + ".png";
  }
  const std::string found = "a frame without the raw image '" + name + "'";
  if (!names.empty()) throw Error({file.path().string(), found, names, "write one of these"});
  throw Error({file.path().string(), found,
               "a frame of a depth camera that is simulated from infrared images", kRemedy});
}

void write_image(const CloudFile& job, const std::string& name, AtomicFile& file) {
  constexpr std::uint32_t kMaxByte = 255;
  const GreyImage& image = find_image(job.frame, name, file);
  if (image.max_level > kMaxByte) {
    write_png({PngKind::grey16, image.width, image.height, std::as_bytes(std::span(image.level)),
               job.pixels},
              file);
    return;
  }
  std::vector<std::uint8_t> grey(image.level.size());
  std::transform(image.level.begin(), image.level.end(), grey.begin(),
                 [](std::uint16_t level) { return static_cast<std::uint8_t>(level); });
  write_png({PngKind::grey8, image.width, image.height, std::as_bytes(std::span(grey)), job.pixels},
            file);
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

}  // namespace glidar
