// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/depth_filters.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

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

namespace {

using Depths = std::vector<std::uint16_t>;
using Disparities = std::vector<float>;

/// An image between two filters: depths in units, or disparities in 1/32 px; 0: none.
struct FilterImage {
  std::size_t width = 0;
  std::size_t height = 0;
  std::variant<Depths, Disparities> values;
  float focal_length_px = 0.0F;
};

constexpr std::size_t kMaxMedianSide = 3;
constexpr std::size_t kMaxSide = 8;

/// The depths of a block, without holes.
struct Block {
  std::array<std::uint16_t, kMaxSide * kMaxSide> depth;
  std::size_t count = 0;
};

Block collect_block(const std::uint16_t* corner, std::size_t side, std::size_t stride) {
  Block block;
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = 0; x < side; ++x) {
      const std::uint16_t depth = corner[y * stride + x];
      if (depth != 0) block.depth[block.count++] = depth;
    }
  }
  return block;
}

/// Of an even number, the lower one of the two in the middle.
std::uint16_t median(Block& block) {
  const auto middle = block.depth.begin() + static_cast<std::ptrdiff_t>((block.count - 1) / 2);
  std::nth_element(block.depth.begin(), middle,
                   block.depth.begin() + static_cast<std::ptrdiff_t>(block.count));
  return *middle;
}

std::uint16_t mean(const Block& block) {
  std::size_t sum = 0;
  for (std::size_t i = 0; i < block.count; ++i) sum += block.depth[i];
  return static_cast<std::uint16_t>(sum / block.count);
}

std::size_t multiple_of_4(std::size_t size) {
  return (size + 3) / 4 * 4;
}

/// Of an image of depths.
void apply(const DecimationFilter& filter, FilterImage& image) {
  const std::size_t side = filter.magnitude;
  const auto& depth = std::get<Depths>(image.values);
  const std::size_t columns = image.width / side;
  const std::size_t rows = image.height / side;
  if (columns == 0 || rows == 0) {
    throw Error({"depth filter decimation",
                 "the image has " + std::to_string(image.width) + "x" +
                     std::to_string(image.height) + " pixels, less than one block",
                 "at least " + std::to_string(side) + " rows and columns",
                 "use a smaller magnitude"});
  }
  const std::size_t width = multiple_of_4(columns);
  std::vector<std::uint16_t> decimated(width * multiple_of_4(rows), 0);
  for (std::size_t y = 0; y < rows; ++y) {
    for (std::size_t x = 0; x < columns; ++x) {
      Block block = collect_block(depth.data() + (y * image.width + x) * side, side, image.width);
      if (block.count == 0) continue;
      decimated[y * width + x] = side <= kMaxMedianSide ? median(block) : mean(block);
    }
  }
  image.width = width;
  image.height = multiple_of_4(rows);
  image.focal_length_px /= static_cast<float>(side);
  image.values = std::move(decimated);
}

/// Removes depths outside the interval.
void apply(const ThresholdFilter& filter, double unit_m, FilterImage& image) {
  const auto unit = static_cast<float>(unit_m);
  const auto min_m = static_cast<float>(filter.min_m);
  const auto max_m = static_cast<float>(filter.max_m);
  for (std::uint16_t& depth : std::get<Depths>(image.values)) {
    const float depth_m = unit * static_cast<float>(depth);
    if (!(depth_m >= min_m && depth_m <= max_m)) depth = 0;
  }
}

constexpr float kStepsPerPixel = 32.0F;
constexpr float kDepthEnd = 65536.0F;  ///< above 16 bits

/// f b 32 / unit: the product of a depth in units and its disparity in 1/32 px.
/// In the units and order of librealsense: the baseline is in millimetres there.
float disparity_factor(double baseline_m, float focal_length_px, double unit_m) {
  const float baseline_mm = static_cast<float>(baseline_m * 1000.0);
  const float baseline = baseline_mm * 0.001F;
  return baseline * focal_length_px * kStepsPerPixel / static_cast<float>(unit_m);
}

void to_disparity(float factor, FilterImage& image) {
  const auto& depth = std::get<Depths>(image.values);
  std::vector<float> disparity(depth.size(), 0.0F);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (depth[i] != 0) disparity[i] = factor / static_cast<float>(depth[i]);
  }
  image.values = std::move(disparity);
}

/// Rounded; 0 beyond 16 bits.
void to_depth(float factor, FilterImage& image) {
  const auto& disparity = std::get<Disparities>(image.values);
  std::vector<std::uint16_t> depth(disparity.size(), 0);
  for (std::size_t i = 0; i < disparity.size(); ++i) {
    if (!std::isnormal(disparity[i])) continue;
    const float units = factor / disparity[i] + 0.5F;
    if (units < kDepthEnd) depth[i] = static_cast<std::uint16_t>(units);
  }
  image.values = std::move(depth);
}

/// From this many pixels on, a hole along a row is not filled. Unlimited is 255 in librealsense.
std::size_t hole_limit(HoleWidth width) {
  if (width == HoleWidth::none) return 0;
  if (width == HoleWidth::unlimited) return 255;
  return std::size_t{1} << static_cast<unsigned>(width);
}

struct Smoothing {
  float alpha;
  float rest;  ///< 1 - alpha
  float delta;
  std::size_t hole_limit;
};

/// The moving average along a line of disparities.
struct DisparityAverage {
  float last = 0.0F;  ///< the value before, as it came in
  float average = 0.0F;
};

float smooth_disparity(const Smoothing& smoothing, float value, DisparityAverage& line) {
  const float last = std::exchange(line.last, value);
  if (!(value > 0.0F)) return value;
  const float step = last - value;
  const bool continues = last > 0.0F && step < smoothing.delta && step > -smoothing.delta;
  line.average = continues ? value * smoothing.alpha + line.average * smoothing.rest : value;
  return line.average;
}

void smooth_rows(const Smoothing& smoothing, std::size_t width, std::vector<float>& values) {
  for (std::size_t row = 0; row < values.size(); row += width) {
    DisparityAverage forwards;
    for (std::size_t x = 0; x < width; ++x) {
      values[row + x] = smooth_disparity(smoothing, values[row + x], forwards);
    }
    DisparityAverage backwards;
    for (std::size_t x = width; x-- > 0;) {
      values[row + x] = smooth_disparity(smoothing, values[row + x], backwards);
    }
  }
}

void smooth_columns(const Smoothing& smoothing, std::size_t width, std::vector<float>& values) {
  std::vector<DisparityAverage> down(width);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = smooth_disparity(smoothing, values[i], down[i % width]);
  }
  std::vector<DisparityAverage> up(width);
  for (std::size_t row = values.size(); row > 0;) {
    row -= width;
    for (std::size_t x = 0; x < width; ++x) {
      values[row + x] = smooth_disparity(smoothing, values[row + x], up[x]);
    }
  }
}

/// Copies `neighbour` into a hole that is not wider than the limit; `run` counts its pixels.
void fill_pixel(std::size_t limit, float neighbour, std::size_t& run, float& value) {
  if (value != 0.0F) {
    run = 0;
  } else if (++run < limit) {
    value = neighbour;
  }
}

/// Fills from the left, then from the right. As in librealsense, the right neighbour of the last
/// pixel of a row is the first one of the next row, and the first pixel is not filled.
void fill_rows(std::size_t limit, std::size_t width, std::vector<float>& values) {
  for (std::size_t row = 0; row < values.size(); row += width) {
    std::size_t run = 0;
    for (std::size_t i = row + 1; i < row + width; ++i) {
      fill_pixel(limit, values[i - 1], run, values[i]);
    }
    run = 0;
    for (std::size_t i = row + width - 1; i > row; --i) {
      const float neighbour = i + 1 < values.size() ? values[i + 1] : 0.0F;
      fill_pixel(limit, neighbour, run, values[i]);
    }
  }
}

void smooth(const SpatialFilter& filter, const Smoothing& smoothing, std::size_t width,
            std::vector<float>& values) {
  for (std::uint32_t pass = 0; pass < filter.magnitude; ++pass) {
    smooth_rows(smoothing, width, values);
    smooth_columns(smoothing, width, values);
  }
  if (smoothing.hole_limit > 0) fill_rows(smoothing.hole_limit, width, values);
}

std::uint16_t mix_depths(const Smoothing& smoothing, std::uint16_t value, std::uint16_t last) {
  const float mixed =
      static_cast<float>(value) * smoothing.alpha + static_cast<float>(last) * smoothing.rest;
  return static_cast<std::uint16_t>(std::floor(mixed + 0.5F));
}

float step_between(std::uint16_t a, std::uint16_t b) {
  return static_cast<float>(std::abs(int{a} - int{b}));
}

/// Mixes `value` with the pixel before it in the row, or fills it. Values of less than `least` are
/// holes. Returns the new value.
std::uint16_t smooth_row_depth(const Smoothing& smoothing, std::uint16_t least, std::uint16_t last,
                               std::uint16_t value, std::size_t& run) {
  if (last == 0) return value;
  if (value >= least) {
    run = 0;
    if (step_between(value, last) > smoothing.delta) return value;
    return mix_depths(smoothing, value, last);
  }
  return smoothing.hole_limit > 0 && ++run < smoothing.hole_limit ? last : value;
}

/// As in librealsense, the last column is not changed forwards, and depths of 1 are holes
/// backwards.
void smooth_rows(const Smoothing& smoothing, std::size_t width, Depths& values) {
  for (std::size_t row = 0; row < values.size(); row += width) {
    std::size_t run = 0;
    for (std::size_t i = row + 1; i + 1 < row + width; ++i) {
      values[i] = smooth_row_depth(smoothing, 1, values[i - 1], values[i], run);
    }
    run = 0;
    for (std::size_t i = row + width - 1; i-- > row;) {
      values[i] = smooth_row_depth(smoothing, 2, values[i + 1], values[i], run);
    }
  }
}

/// As in librealsense, holes take part downwards if the depth beside them is below delta.
void smooth_columns(const Smoothing& smoothing, std::size_t width, Depths& values) {
  for (std::size_t i = width; i < values.size(); ++i) {
    const std::uint16_t above = values[i - width];
    if (step_between(above, values[i]) < smoothing.delta) {
      values[i] = mix_depths(smoothing, values[i], above);
    }
  }
  for (std::size_t i = values.size() - width; i-- > 0;) {
    const std::uint16_t below = values[i + width];
    if (values[i] == 0 || below == 0) continue;
    if (step_between(below, values[i]) < smoothing.delta) {
      values[i] = mix_depths(smoothing, values[i], below);
    }
  }
}

void smooth(const SpatialFilter& filter, const Smoothing& smoothing, std::size_t width,
            Depths& values) {
  for (std::uint32_t pass = 0; pass < filter.magnitude; ++pass) {
    smooth_rows(smoothing, width, values);
    smooth_columns(smoothing, width, values);
  }
}

/// Disparities are smoothed in single precision. Of depths, which are rounded after each step,
/// holes are filled in the same passes.
void apply(const SpatialFilter& filter, FilterImage& image) {
  const auto alpha = static_cast<float>(filter.alpha);
  const Smoothing smoothing = {alpha, 1.0F - alpha, static_cast<float>(filter.delta),
                               hole_limit(filter.hole_filling)};
  std::visit([&](auto& values) { smooth(filter, smoothing, image.width, values); }, image.values);
}

/// The frames before.
struct TemporalState {
  std::vector<float> last;  ///< the last value of each pixel; depths are whole; empty: no frame yet
  /// Which of the last 8 frames had a value that continued the one before, a bit for each frame of
  /// a cycle of 8.
  std::vector<std::uint8_t> history;
  unsigned frame = 0;  ///< of the cycle
};

constexpr unsigned kCycle = 8;

/// A hole keeps its last value when at least `valid` of the last `frames` frames had one.
struct Persistence {
  int valid;
  unsigned frames;
};
constexpr std::array<Persistence, 9> kPersistence = {
    {{9, 8}, {8, 8}, {2, 3}, {2, 4}, {2, 8}, {1, 2}, {1, 5}, {1, 8}, {0, 8}}};

/// `history` at the bit `frame` is about the frame 8 before this one.
bool persists(const Persistence& rule, std::uint8_t history, unsigned frame) {
  const std::uint8_t newest_first = std::rotl(history, static_cast<int>(kCycle - frame));
  const auto recent = static_cast<std::uint8_t>(newest_first >> (kCycle - rule.frames));
  return std::popcount(recent) >= rule.valid;
}

struct Averaging {
  float alpha;
  float rest;  ///< 1 - alpha
  float delta;
  Persistence persistence;
  unsigned frame;
};

/// The value of one pixel; updates what is kept of it. Depths are rounded down.
template <class Value>
Value average_pixel(const Averaging& rule, Value value, float& last, std::uint8_t& history) {
  const auto bit = static_cast<std::uint8_t>(1U << rule.frame);
  const auto now = static_cast<float>(value);
  if (value == Value{}) {
    const bool is_kept = last != 0.0F && persists(rule.persistence, history, rule.frame);
    history = static_cast<std::uint8_t>(history & ~bit);
    return is_kept ? static_cast<Value>(last) : value;
  }
  if (last == 0.0F || !(std::fabs(now - last) < rule.delta)) {
    last = now;
    history = bit;
    return value;
  }
  history = static_cast<std::uint8_t>(history | bit);
  const auto mixed = static_cast<Value>(rule.alpha * now + rule.rest * last);
  last = static_cast<float>(mixed);
  return mixed;
}

void apply(const TemporalFilter& filter, FilterImage& image, TemporalState& state) {
  const std::size_t pixels = image.width * image.height;
  if (state.last.size() != pixels)
    state = {std::vector<float>(pixels), std::vector<std::uint8_t>(pixels), 0};
  const auto alpha = static_cast<float>(filter.alpha);
  const Averaging rule = {alpha, 1.0F - alpha, static_cast<float>(filter.delta),
                          kPersistence[filter.persistence], state.frame};
  std::visit(
      [&](auto& values) {
        for (std::size_t i = 0; i < pixels; ++i) {
          values[i] = average_pixel(rule, values[i], state.last[i], state.history[i]);
        }
      },
      image.values);
  state.frame = (state.frame + 1) % kCycle;
}

/// The pixels above, above on the left, on the left, below on the left and below.
template <class Value>
std::array<Value, 5> neighbours(const Value* pixel, std::size_t width) {
  return {pixel[-static_cast<std::ptrdiff_t>(width)],
          pixel[-static_cast<std::ptrdiff_t>(width) - 1], pixel[-1], pixel[width - 1],
          pixel[width]};
}

template <class Value>
Value farthest(const std::array<Value, 5>& around) {
  return *std::max_element(around.begin(), around.end());
}

/// As in librealsense, a hole above means that there is none.
template <class Value>
Value nearest(const std::array<Value, 5>& around) {
  Value least = around.front();
  for (const Value value : around) {
    if (value != Value{} && value < least) least = value;
  }
  return least;
}

template <class Value>
void fill_from_left(std::size_t width, std::vector<Value>& values) {
  for (std::size_t row = 0; row < values.size(); row += width) {
    for (std::size_t i = row + 1; i < row + width; ++i) {
      if (values[i] == Value{}) values[i] = values[i - 1];
    }
  }
}

/// All but the first column, the first row and the last row.
template <class Value, class Select>
void fill_from_around(const FilterImage& image, std::vector<Value>& values, const Select& select) {
  for (std::size_t y = 1; y + 1 < image.height; ++y) {
    for (std::size_t x = 1; x < image.width; ++x) {
      Value& value = values[y * image.width + x];
      if (value == Value{}) value = select(neighbours(&value, image.width));
    }
  }
}

template <class Value>
void fill(HoleSource source, const FilterImage& image, std::vector<Value>& values) {
  if (source == HoleSource::left) return fill_from_left(image.width, values);
  if (source == HoleSource::farthest) {
    return fill_from_around(image, values, [](const auto& a) { return farthest(a); });
  }
  fill_from_around(image, values, [](const auto& a) { return nearest(a); });
}

/// Fills in place, row by row: a filled pixel fills the next one. "Farthest" is the greatest and
/// "nearest" the least value, also of disparities.
void apply(const HoleFillingFilter& filter, FilterImage& image) {
  std::visit([&](auto& values) { fill(filter.source, image, values); }, image.values);
}

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
  TemporalState& temporal;
  FilterImage& image;
  float& factor;

  void operator()(const DecimationFilter& filter) const { apply(filter, image); }
  void operator()(const ThresholdFilter& filter) const { apply(filter, camera.unit_m, image); }
  void operator()(const ToDisparity& filter) const {
    factor = disparity_factor(filter.baseline_m, image.focal_length_px, camera.unit_m);
    to_disparity(factor, image);
  }
  void operator()(const ToDepth& /*filter*/) const { to_depth(factor, image); }
  void operator()(const SpatialFilter& filter) const { apply(filter, image); }
  void operator()(const TemporalFilter& filter) const { apply(filter, image, temporal); }
  void operator()(const HoleFillingFilter& filter) const { apply(filter, image); }
};

}  // namespace

struct DepthFilterChain::State {
  std::vector<DepthFilter> filters;
  DepthFilterCamera camera;
  std::uint32_t width = 0;              ///< of the image before
  std::uint32_t height = 0;             ///< of it
  std::vector<TemporalState> temporal;  ///< for each filter, used by temporal ones
};

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
  FilterImage values = {image.width, image.height, image.depth,
                        static_cast<float>(state_->camera.focal_length_px)};
  float factor = 0.0F;
  for (std::size_t i = 0; i < state_->filters.size(); ++i) {
    std::visit(ApplyFilter{state_->camera, state_->temporal[i], values, factor},
               state_->filters[i]);
  }
  return {static_cast<std::uint32_t>(values.width), static_cast<std::uint32_t>(values.height),
          std::get<Depths>(std::move(values.values))};
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
