// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth/depth_filter.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>

#include <array>
#include <string>
#include <type_traits>

namespace glidar {

namespace {

constexpr WholeRule kDecimationRule = {1, 8};
constexpr WholeRule kSpatialDeltaRule = {1, 50};
constexpr WholeRule kPassRule = {1, 5};
constexpr WholeRule kTemporalDeltaRule = {1, 100};
constexpr WholeRule kPersistenceRule = {0, 8};
constexpr NumberRule kSpatialAlphaRule = {0.25, 1.0, false, "a number from 0.25 to 1"};
constexpr NumberRule kThresholdRule = {0.0, 65.535, false, "metres from 0 to 65.535"};
/// Far above the baseline of any camera; disparities in float are finite.
constexpr NumberRule kBaselineRule = {0.0, 1e3, true, "metres above 0 and below 1000"};

constexpr std::array<Named<HoleWidth>, 6> kHoleWidthNames = {{{"none", HoleWidth::none},
                                                              {"2", HoleWidth::px_2},
                                                              {"4", HoleWidth::px_4},
                                                              {"8", HoleWidth::px_8},
                                                              {"16", HoleWidth::px_16},
                                                              {"unlimited", HoleWidth::unlimited}}};
constexpr std::array<Named<HoleSource>, 3> kHoleSourceNames = {{{"left", HoleSource::left},
                                                                {"farthest", HoleSource::farthest},
                                                                {"nearest", HoleSource::nearest}}};

std::string place_of(std::size_t i, const DepthFilter& filter) {
  return "depth filter " + std::to_string(i + 1) + ", " + type_info(filter).name;
}

/// Checks values as a reader does.
class RuleCheck : public FieldVisitor {
 public:
  explicit RuleCheck(std::string place) : place_(std::move(place)) {}

  [[nodiscard]] Mode mode() const override { return Mode::keys; }
  void number(const FieldInfo& field, const NumberRule& rule, double& value) override {
    if (accepts(rule, value)) return;
    throw Error({place_ + ", " + field.key, "is " + number_text(value), rule.allowed, ""});
  }
  void whole_number(const FieldInfo& field, const WholeRule& rule, std::uint32_t& value) override {
    if (value >= rule.min && value <= rule.max) return;
    throw Error(
        {place_ + ", " + field.key, "is " + std::to_string(value),
         "a whole number from " + std::to_string(rule.min) + " to " + std::to_string(rule.max),
         ""});
  }
  void variant(const FieldInfo& /*field*/, std::span<const TypeInfo> /*types*/, std::size_t chosen,
               DescribeAt describe) override {
    describe(chosen, *this);
  }

 private:
  std::string place_;
};

void check_interval(const ThresholdFilter& filter, const std::string& place) {
  if (filter.min_m <= filter.max_m) return;
  throw Error({place + ", max_m", "is below min_m: " + number_text(filter.max_m),
               "at least min_m, " + number_text(filter.min_m), ""});
}

bool is_for_depths(const DepthFilter& filter) {
  return std::holds_alternative<DecimationFilter>(filter) ||
         std::holds_alternative<ThresholdFilter>(filter) ||
         std::holds_alternative<ToDisparity>(filter);
}

/// Follows whether the values are disparities.
bool check_order(const DepthFilter& filter, const std::string& place, bool is_disparity) {
  if (is_disparity && is_for_depths(filter)) {
    throw Error({place, "it would take disparities", "depths",
                 "move it before to_disparity, or behind to_depth"});
  }
  if (!is_disparity && std::holds_alternative<ToDepth>(filter)) {
    throw Error({place, "it would take depths", "disparities", "add to_disparity before it"});
  }
  if (std::holds_alternative<ToDisparity>(filter)) return true;
  return is_disparity && !std::holds_alternative<ToDepth>(filter);
}

}  // namespace

void describe(DecimationFilter& filter, FieldVisitor& visitor) {
  visitor.whole_number({"magnitude", "side of a block; 1 to 8", kUnitPixel}, kDecimationRule,
                       filter.magnitude);
}

void describe(ThresholdFilter& filter, FieldVisitor& visitor) {
  visitor.number({"min_m", "least depth that is kept", kUnitMetre}, kThresholdRule, filter.min_m);
  visitor.number({"max_m", "greatest depth that is kept", kUnitMetre}, kThresholdRule,
                 filter.max_m);
}

void describe(ToDisparity& filter, FieldVisitor& visitor) {
  visitor.number({"baseline_m", "distance of the two cameras", kUnitMetre, kRequired},
                 kBaselineRule, filter.baseline_m);
}

void describe(ToDepth& /*filter*/, FieldVisitor& /*visitor*/) {}

void describe(SpatialFilter& filter, FieldVisitor& visitor) {
  visitor.number({"alpha", "weight of the pixel in the moving average; 1: no smoothing"},
                 kSpatialAlphaRule, filter.alpha);
  visitor.whole_number(
      {"delta", "step from which pixels are not mixed, in units of depth or 1/32 px; 1 to 50"},
      kSpatialDeltaRule, filter.delta);
  visitor.whole_number({"magnitude", "number of passes; 1 to 5"}, kPassRule, filter.magnitude);
  visit_choice(visitor, {"hole_filling", "width of holes that are filled along rows", kUnitPixel},
               kHoleWidthNames, filter.hole_filling);
}

void describe(TemporalFilter& filter, FieldVisitor& visitor) {
  visitor.number({"alpha", "weight of the new frame in the moving average; 1: no smoothing"},
                 kZeroToOne, filter.alpha);
  visitor.whole_number(
      {"delta", "change from which frames are not mixed, in units of depth or 1/32 px; 1 to 100"},
      kTemporalDeltaRule, filter.delta);
  visitor.whole_number({"persistence",
                        "when a hole keeps its last value: 0 never; 1 valid in 8 of the last 8 "
                        "frames; 2 in 2 of 3; 3 in 2 of 4; 4 in 2 of 8; 5 in 1 of 2; 6 in 1 of 5; "
                        "7 in 1 of 8; 8 always"},
                       kPersistenceRule, filter.persistence);
}

void describe(HoleFillingFilter& filter, FieldVisitor& visitor) {
  visit_choice(visitor,
               {"source",
                "the pixel on the left; or the farthest or nearest of the neighbours "
                "above, below and on the left (of disparities the other way round)"},
               kHoleSourceNames, filter.source);
}

void describe(DepthFilter& filter, FieldVisitor& visitor) {
  visit_variant(visitor, {"type", "the filter"}, filter);
}

void validate(std::span<const DepthFilter> filters) {
  bool is_disparity = false;
  for (std::size_t i = 0; i < filters.size(); ++i) {
    const std::string place = place_of(i, filters[i]);
    RuleCheck check(place);
    DepthFilter copy = filters[i];
    describe(copy, check);
    if (const auto* limits = std::get_if<ThresholdFilter>(&copy)) check_interval(*limits, place);
    is_disparity = check_order(filters[i], place, is_disparity);
  }
  if (!is_disparity) return;
  throw Error({"depth filters", "the list ends with disparities", "depths", "add to_depth"});
}

std::vector<DepthFilter> recommended_depth_filters(double baseline_m) {
  if (baseline_m <= 0.0) {
    return {DecimationFilter{}, SpatialFilter{}, TemporalFilter{}, HoleFillingFilter{}};
  }
  return {DecimationFilter{}, ToDisparity{baseline_m}, SpatialFilter{}, TemporalFilter{},
          ToDepth{},          HoleFillingFilter{}};
}

}  // namespace glidar
