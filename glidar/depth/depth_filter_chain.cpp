// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth/depth_filter_chain.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/depth/conversion.hpp>
#include <glidar/depth/decimation.hpp>
#include <glidar/depth/hole_filling.hpp>
#include <glidar/depth/spatial.hpp>
#include <glidar/depth/temporal.hpp>

#include <cmath>
#include <string>
#include <utility>

namespace glidar {

struct DepthFilterChain::State {
  std::vector<DepthFilter> filters;
  DepthFilterCamera camera;
  std::uint32_t width = 0;                     ///< of the image before
  std::uint32_t height = 0;                    ///< of it
  std::vector<depth::TemporalState> temporal;  ///< for each filter, used by temporal ones
};

namespace {

void require_camera(std::span<const DepthFilter> filters, const DepthFilterCamera& camera) {
  require_number(accepts(kAboveZero, camera.unit_m), "camera of depth filters, unit_m",
                 camera.unit_m, kAboveZero.allowed);
  require_number(accepts(kFromZero, camera.focal_length_px),
                 "camera of depth filters, focal_length_px", camera.focal_length_px,
                 kFromZero.allowed);
  if (camera.focal_length_px > 0.0) return;
  for (const DepthFilter& filter : filters) {
    if (!std::holds_alternative<ToDisparity>(filter)) continue;
    throw Error({"depth filter to_disparity", "there is no focal length",
                 "the focal length of the images in pixels", "add focal_length_px"});
  }
}

void require_depths(const DepthImage& image) {
  const std::size_t pixels = std::size_t{image.width} * image.height;
  if (pixels > 0 && image.depth.size() == pixels) return;
  throw Error({"depth image",
               "has " + std::to_string(image.depth.size()) + " depths for " +
                   std::to_string(image.width) + "x" + std::to_string(image.height) + " pixels",
               "one for each pixel, at least one", ""});
}

/// Applies one filter; `factor` is that of the last conversion to disparities.
struct ApplyFilter {
  const DepthFilterCamera& camera;
  depth::TemporalState& temporal;
  depth::FilterImage& image;
  float& factor;

  void operator()(const DecimationFilter& filter) const { depth::apply(filter, image); }
  void operator()(const ThresholdFilter& filter) const {
    depth::apply(filter, camera.unit_m, image);
  }
  void operator()(const ToDisparity& filter) const {
    factor = depth::disparity_factor(filter.baseline_m, image.focal_length_px, camera.unit_m);
    depth::to_disparity(factor, image);
  }
  void operator()(const ToDepth& /*filter*/) const { depth::to_depth(factor, image); }
  void operator()(const SpatialFilter& filter) const { depth::apply(filter, image); }
  void operator()(const TemporalFilter& filter) const { depth::apply(filter, image, temporal); }
  void operator()(const HoleFillingFilter& filter) const { depth::apply(filter, image); }
};

}  // namespace

void describe(DepthFilterCamera& camera, FieldVisitor& visitor) {
  visitor.number({"focal_length_px",
                  "along rows, of the images before the filters; for `to_disparity`", kUnitPixel},
                 kFromZero, camera.focal_length_px);
  visitor.number({"unit_m", "of depths", kUnitMetre}, kAboveZero, camera.unit_m);
}

DepthFilterChain::DepthFilterChain(std::span<const DepthFilter> filters,
                                   const DepthFilterCamera& camera)
    : state_(std::make_unique<State>()) {
  validate(filters);
  require_camera(filters, camera);
  state_->filters.assign(filters.begin(), filters.end());
  state_->camera = camera;
  reset();
}

DepthFilterChain::~DepthFilterChain() = default;
DepthFilterChain::DepthFilterChain(DepthFilterChain&&) noexcept = default;
DepthFilterChain& DepthFilterChain::operator=(DepthFilterChain&&) noexcept = default;

void DepthFilterChain::reset() {
  state_->temporal.assign(state_->filters.size(), {});
}

DepthImage DepthFilterChain::apply(const DepthImage& image) {
  require_depths(image);
  if (image.width != state_->width || image.height != state_->height) reset();
  state_->width = image.width;
  state_->height = image.height;
  depth::FilterImage values = {image.width, image.height, image.depth,
                               static_cast<float>(state_->camera.focal_length_px)};
  float factor = 0.0F;
  for (std::size_t i = 0; i < state_->filters.size(); ++i) {
    std::visit(ApplyFilter{state_->camera, state_->temporal[i], values, factor},
               state_->filters[i]);
  }
  return {static_cast<std::uint32_t>(values.width), static_cast<std::uint32_t>(values.height),
          std::get<std::vector<std::uint16_t>>(std::move(values.values))};
}

DepthFilterCamera filtered_camera(std::span<const DepthFilter> filters, DepthFilterCamera camera) {
  for (const DepthFilter& filter : filters) {
    if (const auto* decimation = std::get_if<DecimationFilter>(&filter)) {
      camera.focal_length_px /= decimation->magnitude;
    }
  }
  return camera;
}

}  // namespace glidar
