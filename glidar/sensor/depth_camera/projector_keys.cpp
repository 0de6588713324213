// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/depth_camera/projector_keys.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/core/pose_keys.hpp>
#include <glidar/structured_light/pattern_size.hpp>

#include <algorithm>

namespace glidar {
namespace {

constexpr const char* kProjectorKey = "projector";
constexpr const char* kPoseKey = "projector_from_camera";

const ErrorParts& baseline_fault() {
  static const ErrorParts kFault = {kPoseKey, "the projector is at the position of the camera",
                                    "a distance between them, from which depths are triangulated",
                                    "write a position other than [0, 0, 0]"};
  return kFault;
}

bool has_baseline(const Pose& projector_from_camera) {
  return !projector_from_camera.translation().isZero(0.0);
}

}  // namespace

void visit_projector(FieldVisitor& visitor, const char* text, Pinhole& projector,
                     Pose& projector_from_camera, FringePatterns& patterns) {
  visit_object(visitor, {kProjectorKey, text, kNoUnit, kRequired}, projector);
  visit_pose(visitor,
             {kPoseKey, "the camera in the optical frame of the projector", kNoUnit, kRequired},
             true, projector_from_camera);
  if (!visitor.is_reading()) return;
  patterns.width = projector.intrinsics.width;
  patterns.height = projector.intrinsics.height;
  if (std::max(patterns.width, patterns.height) > kPatternSideRule.max) {
    visitor.reject(
        kProjectorKey,
        std::to_string(patterns.width) + "x" + std::to_string(patterns.height) + " pixels",
        "a width and a height of at most " + std::to_string(kPatternSideRule.max),
        "use the size of the projector's image");
  }
  const ErrorParts& fault = baseline_fault();
  if (has_baseline(projector_from_camera)) return;
  visitor.reject(kPoseKey, fault.found, fault.allowed, fault.remedy);
}

void validate_baseline(const std::string& where, const Pose& projector_from_camera) {
  if (has_baseline(projector_from_camera)) return;
  ErrorParts fault = baseline_fault();
  fault.where = where + ", " + fault.where;
  throw Error(fault);
}

}  // namespace glidar
