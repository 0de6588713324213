// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/depth_camera.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/depth_camera/stereo_matcher.hpp>
#include <glidar/sensor/optics/pinhole.hpp>

#include <array>
#include <string>

namespace glidar {

void describe(ActiveStereo& camera, FieldVisitor& visitor) {
  using Reference = ActiveStereo::Reference;
  constexpr std::array<Named<Reference>, 2> kReferences = {
      {{"right_imager", Reference::right_imager}, {"pattern", Reference::pattern}}};
  visit_choice(visitor,
               {"reference",
                "what the left image is matched with: a second image, or the stored pattern as "
                "seen from the projector"},
               kReferences, camera.reference);
  visitor.number({"baseline_m", "from the left to the right imager, along x", kUnitMetre},
                 {0.0, 10.0, true, "metres above 0 and below 10"}, camera.baseline_m);
  visitor.number({"depth_unit_m", "depths are multiples of this; 0: not rounded", kUnitMetre},
                 kFromZero, camera.depth_unit_m);
  visitor.whole_number({"sub_rays", "each pixel is the mean of `sub_rays` x `sub_rays` rays"},
                       {1, 16}, camera.sub_rays);
  visit_object(visitor, {"projector", "the dot pattern"}, camera.projector);
  visit_object(visitor, {"illumination", "other infrared light"}, camera.illumination);
  visit_object(visitor, {"imager", "the infrared imagers"}, camera.imager);
  visit_object(visitor, {"matcher", "see [stereo matching](../stereo.md)"}, camera.matcher);
  if (!visitor.is_reading()) return;
  try {
    validate(camera);
  } catch (const Error& error) {
    const ErrorParts& parts = error.parts();
    visitor.reject("type", parts.where + ": " + parts.found, parts.allowed, parts.remedy);
  }
}

Eigen::Vector3d second_origin_m(const ActiveStereo& camera) {
  return camera.baseline_m * Eigen::Vector3d::UnitX();
}

void validate(const ActiveStereo& camera) {
  validate(camera.matcher);
  const Eigen::Vector3d& projector = camera.projector.origin_m;
  const bool is_displaced = projector != second_origin_m(camera);
  if (camera.reference == ActiveStereo::Reference::pattern && is_displaced) {
    throw Error({.where = "projector, origin_m",
                 .found = "not the place from which the pattern is seen",
                 .allowed = "[baseline_m, 0, 0] with `reference: pattern`",
                 .remedy = "write the baseline as x"});
  }
}

void check_image(const ActiveStereo& camera, const PinholeIntrinsics& image) {
  const std::uint64_t reach =
      std::uint64_t{camera.matcher.min_disparity_px} + camera.matcher.disparities;
  if (reach > image.width) {
    throw Error({.where = "depth_camera, matcher",
                 .found = "min_disparity_px + disparities is " + std::to_string(reach) +
                          ", wider than the image",
                 .allowed = "at most its " + std::to_string(image.width) + " columns",
                 .remedy = "search fewer disparities"});
  }
  stereo::check_volume(image.width, image.height, camera.matcher.disparities);
  check_sub_rays(image, camera.sub_rays);
}

namespace {

constexpr std::array<Named<DepthModel>, 2> kModels = {
    {{"law", DepthModel::law}, {"physical", DepthModel::physical}}};

}  // namespace

void describe(DepthCamera& camera, FieldVisitor& visitor) {
  visit_variant(visitor, {"type", "how the camera measures", kNoUnit, kRequired}, camera);
}

void visit_depth_model(DepthModel& model, FieldVisitor& visitor) {
  visit_choice(visitor,
               {"depth_model",
                "`law`: the true depth with the steps of `noise`; `physical`: from the raw images "
                "of `depth_camera`, without these steps"},
               kModels, model);
}

}  // namespace glidar
