// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/depth_camera/depth_camera.hpp>

#include <glidar/core/field_visitor.hpp>

#include <array>

namespace glidar {
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
