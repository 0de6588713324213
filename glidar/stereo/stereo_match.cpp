// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/stereo/stereo_match.hpp>

#include <glidar/core/error.hpp>
#include <glidar/stereo/matcher.hpp>

#include <utility>

namespace glidar {

namespace {

std::string size_text(const GreyImage& image) {
  return std::to_string(image.width) + "x" + std::to_string(image.height);
}

void require_image(const GreyImage& image, const char* where) {
  const std::size_t pixels = std::size_t{image.width} * image.height;
  if (pixels == 0) {
    throw Error(
        {where, "has no pixels: " + size_text(image), "at least one row and one column", ""});
  }
  if (image.level.size() == pixels) return;
  throw Error({where,
               "has " + std::to_string(image.level.size()) + " grey levels for " +
                   size_text(image) + " pixels",
               "one for each pixel", ""});
}

/// The sums without their padding and offset.
std::vector<std::uint16_t> copy_costs(const stereo::CostVolume& volume) {
  std::vector<std::uint16_t> cost(volume.width * volume.height * volume.disparities);
  auto to = cost.begin();
  for (std::size_t pixel = 0; pixel < volume.width * volume.height; ++pixel) {
    const std::int16_t* const from = volume.sum.data() + pixel * volume.lanes;
    for (std::size_t d = 0; d < volume.disparities; ++d) {
      *to++ = static_cast<std::uint16_t>(from[d] + stereo::kSumOffset);
    }
  }
  return cost;
}

}  // namespace

void require_pair(const GreyImage& left, const GreyImage& right, const StereoOptions& options) {
  require_image(left, "left image");
  require_image(right, "right image");
  if (left.width != right.width || left.height != right.height) {
    throw Error({"right image",
                 "has " + size_text(right) + " pixels, the left one " + size_text(left),
                 "images of equal size", "rectify both images to the same size"});
  }
  validate(options);
  const std::uint64_t reach = std::uint64_t{options.min_disparity_px} + options.disparities;
  if (reach > left.width) {
    throw Error(
        {"stereo option disparities",
         "min_disparity_px + disparities is " + std::to_string(reach) + ", wider than the image",
         "at most its " + std::to_string(left.width) + " columns", "search fewer disparities"});
  }
}

const char* to_string(StereoStatus status) {
  static constexpr const char* kNames[kStereoStatusCount] = {
      "valid", "border", "no_texture", "saturated", "out_of_range", "ambiguous", "left_right"};
  return kNames[static_cast<std::size_t>(status)];
}

struct StereoMatcher::Memory {
  stereo::CostVolume volume;
};

StereoMatcher::StereoMatcher(const StereoOptions& options)
    : options_(options), memory_(std::make_unique<Memory>()) {
  validate(options_);
}

StereoMatcher::~StereoMatcher() = default;
StereoMatcher::StereoMatcher(StereoMatcher&&) noexcept = default;
StereoMatcher& StereoMatcher::operator=(StereoMatcher&&) noexcept = default;

StereoMatch StereoMatcher::match(const GreyImage& left, const GreyImage& right,
                                 const StereoRun& run) {
  StereoMatch match = stereo::match_pair(left, right, options_, run, memory_->volume);
  if (run.keeps_costs) match.cost = copy_costs(memory_->volume);
  return match;
}

StereoMatch match_stereo(const GreyImage& left, const GreyImage& right,
                         const StereoOptions& options, const StereoRun& run) {
  return StereoMatcher(options).match(left, right, run);
}

}  // namespace glidar
