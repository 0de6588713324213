// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/depth_camera/structured_light_camera.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/core/sequence_time.hpp>
#include <glidar/sensor/depth_camera/projector_keys.hpp>

#include <string>

namespace glidar {
namespace {

constexpr std::uint64_t kMaxSequencePixels = std::uint64_t{1} << 28U;  // 1.6 GB

double sequence_s(const StructuredLightCamera& camera) {
  return static_cast<double>(image_count(camera.patterns)) * camera.image_interval_s;
}

constexpr const char* kSequenceAllowed = "seconds from 0 to 4";

bool is_sequence_allowed(const StructuredLightCamera& camera) {
  const double time_s = sequence_s(camera);
  return time_s >= 0.0 && time_s <= kMaxSequence_s;
}

}  // namespace

void describe(StructuredLightCamera& camera, FieldVisitor& visitor) {
  visit_projector(visitor,
                  "as pinhole optics: a camera reversed; its width and height, at most "
                  "16384, are those of the patterns",
                  camera.projector, camera.projector_from_camera, camera.patterns);
  visit_object(visitor, {"light", "of the projector"}, camera.light);
  visit_object(visitor, {"patterns", "the projected images"}, camera.patterns);
  visit_object(visitor, {"decoding", "thresholds of the decoder"}, camera.decoding);
  visit_object(visitor, {"illumination", "other light"}, camera.illumination);
  visit_object(visitor, {"imager", "of the camera"}, camera.imager);
  visitor.whole_number({"sub_rays", "each pixel is the mean of `sub_rays` x `sub_rays` rays"},
                       {1, 16}, camera.sub_rays);
  visitor.number({"image_interval_s",
                  "from the start of an image to the next, while the scene moves", kUnitSecond},
                 kFromZero, camera.image_interval_s);
  if (visitor.is_reading() && !is_sequence_allowed(camera)) {
    visitor.reject("image_interval_s",
                   "{}, so that " + std::to_string(image_count(camera.patterns)) + " images take " +
                       number_text(sequence_s(camera)) + " s",
                   std::string(kSequenceAllowed) + " for all images",
                   "use a shorter interval, or fewer images");
  }
}

StructuredLight setup_of(const StructuredLightCamera& camera, const Pinhole& optics) {
  return {.camera = optics,
          .projector = camera.projector,
          .projector_from_camera = camera.projector_from_camera,
          .patterns = camera.patterns,
          .decoding = camera.decoding};
}

void validate(const StructuredLightCamera& camera) {
  validate(camera.patterns);
  const PinholeIntrinsics& projector = camera.projector.intrinsics;
  if (projector.width != camera.patterns.width || projector.height != camera.patterns.height) {
    throw Error({.where = "structured_light, patterns",
                 .found = "have " + std::to_string(camera.patterns.width) + "x" +
                          std::to_string(camera.patterns.height) + " pixels",
                 .allowed = std::to_string(projector.width) + "x" +
                            std::to_string(projector.height) + ", as the projector",
                 .remedy = ""});
  }
  require_number(is_sequence_allowed(camera),
                 "structured_light, image_interval_s times the number of images",
                 sequence_s(camera), kSequenceAllowed);
  validate_baseline("structured_light", camera.projector_from_camera);
}

void check_image(const StructuredLightCamera& camera, const PinholeIntrinsics& image) {
  const std::size_t images = image_count(camera.patterns);
  const std::uint64_t pixels = std::uint64_t{image.width} * image.height * images;
  if (pixels <= kMaxSequencePixels) return;
  throw Error({.where = "depth_camera, patterns",
               .found = std::to_string(images) + " images of " + std::to_string(image.width) + "x" +
                        std::to_string(image.height) + " pixels",
               .allowed = "at most " + std::to_string(kMaxSequencePixels) + " pixels together",
               .remedy = "use a smaller image, fewer steps, or a longer period"});
}

}  // namespace glidar
