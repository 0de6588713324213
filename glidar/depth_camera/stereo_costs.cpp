// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/stereo_matcher.hpp>

#include <glidar/core/error.hpp>

#include <sys/mman.h>

#include <algorithm>
#include <new>
#include <string>
#include <utility>

namespace glidar::stereo {
namespace {

constexpr std::size_t kLargePage = std::size_t{1} << 21;

std::size_t byte_count(std::size_t elements) {
  const std::size_t bytes = elements * sizeof(std::int16_t);
  return (bytes + kLargePage - 1) / kLargePage * kLargePage;
}

/// Levels minus 32768 with a border of repeated edge pixels on all sides.
struct PaddedImage {
  std::size_t stride = 0;
  std::vector<std::int16_t> level;
};

PaddedImage padded(const GreyImage& image, std::size_t radius, bool is_mirrored) {
  PaddedImage result;
  result.stride = image.width + 2 * radius + kLaneBlock;
  result.level.resize(result.stride * (image.height + 2 * radius));
  for (std::size_t row = 0; row < image.height + 2 * radius; ++row) {
    const std::size_t y = std::min<std::size_t>(std::max(row, radius) - radius, image.height - 1);
    const std::uint16_t* const from = image.level.data() + y * image.width;
    std::int16_t* const to = result.level.data() + row * result.stride;
    for (std::size_t column = 0; column < image.width + 2 * radius; ++column) {
      const std::size_t x =
          std::min<std::size_t>(std::max(column, radius) - radius, image.width - 1);
      const std::size_t source = is_mirrored ? image.width - 1 - x : x;
      to[column] = static_cast<std::int16_t>(from[source] - kSumOffset);
    }
  }
  return result;
}

/// Offsets of the pixels that are compared, one pair for each bit.
struct Pairs {
  std::vector<std::ptrdiff_t> first;
  std::vector<std::ptrdiff_t> second;
};

Pairs make_pairs(StereoCensus kind, bool is_mirrored, std::size_t stride) {
  Pairs pairs;
  const bool is_symmetric = kind == StereoCensus::symmetric_7x7;
  const auto radius = static_cast<std::ptrdiff_t>(census_radius_px(kind));
  const std::ptrdiff_t side = 2 * radius + 1;
  const std::ptrdiff_t centre = side * side / 2;
  // of a symmetric census only the pixels before the centre: the others are opposite
  for (std::ptrdiff_t i = 0; i < (is_symmetric ? centre : side * side); ++i) {
    if (i == centre) continue;
    const std::ptrdiff_t dx = i % side - radius;
    const std::ptrdiff_t dy = i / side - radius;
    const std::ptrdiff_t offset =
        dy * static_cast<std::ptrdiff_t>(stride) + (is_mirrored ? -dx : dx);
    pairs.first.push_back(offset);
    pairs.second.push_back(is_symmetric ? -offset : 0);
  }
  return pairs;
}

/// 4 GiB of memory for costs and sums.
constexpr std::uint64_t kMaxCells = std::uint64_t{1} << 30;

std::size_t padded_lanes(std::size_t disparities) {
  return (disparities + kLaneBlock - 1) / kLaneBlock * kLaneBlock;
}

/// Rows of Hamming distances around the rows of a band, of which `total` is the sum over the box.
class BoxRows {
 public:
  BoxRows(const CostSource& source, const CostVolume& volume, CostWorkspace& workspace)
      : source_(source),
        volume_(volume),
        radius_(source.options.box_px / 2),
        slots_(2 * radius_ + 2),
        workspace_(workspace) {
    workspace.distances.resize(slots_ * slot_size());
    workspace.total.assign(volume.row_size(), 0);
  }

  /// The sum for the first row of a band.
  void start(std::size_t y) {
    const std::size_t first = y > radius_ ? y - radius_ : 0;
    for (std::size_t row = first; row <= std::min(y + radius_, last()); ++row) compute(row);
    for (std::size_t i = 0; i <= 2 * radius_; ++i) {
      const std::size_t row = std::min(std::max(y + i, radius_) - radius_, last());
      source_.kernel.add(workspace_.total.data(), slot(row), volume_.row_size());
    }
  }

  /// From the sum for row y - 1 to that for row y.
  void advance(std::size_t y) {
    const std::size_t added = std::min(y + radius_, last());
    const std::size_t removed = std::max(y, radius_ + 1) - radius_ - 1;
    if (y + radius_ <= last()) compute(added);
    if (added == removed) return;
    source_.kernel.slide(workspace_.total.data(), slot(added), slot(removed), volume_.row_size());
  }

 private:
  [[nodiscard]] std::size_t last() const { return volume_.height - 1; }
  [[nodiscard]] std::size_t slot_size() const { return volume_.row_size() + kLaneBlock; }
  [[nodiscard]] std::uint8_t* slot(std::size_t y) const {
    return workspace_.distances.data() + y % slots_ * slot_size();
  }

  void compute(std::size_t y) {
    const std::uint32_t bits = census_bits(source_.options.census);
    source_.kernel.hamming({.left = source_.left.row(y),
                            .right = source_.right.row(y),
                            .left_stride = source_.left.plane_stride,
                            .right_stride = source_.right.plane_stride,
                            .planes = source_.left.planes,
                            .width = volume_.width,
                            .lanes = volume_.lanes,
                            .min_disparity = source_.options.min_disparity_px,
                            .outside = static_cast<std::uint8_t>(bits / 2),
                            .distances = slot(y)});
  }

  const CostSource& source_;
  const CostVolume& volume_;
  std::size_t radius_;
  std::size_t slots_;
  CostWorkspace& workspace_;
};

void sweep_both_ways(const CostSource& source, std::size_t y, CostVolume& volume,
                     CostWorkspace& workspace) {
  SweepRow row = {.cost = volume.cost.data() + volume.offset(y),
                  .sum = volume.sum.data() + volume.offset(y),
                  .width = volume.width,
                  .lanes = volume.lanes,
                  .disparities = volume.disparities,
                  .p1 = static_cast<std::int16_t>(penalty_p1(source.options)),
                  .p2 = static_cast<std::int16_t>(penalty_p2(source.options)),
                  .is_first = true,
                  .state = workspace.state.data()};
  source.kernel.sweep(row);
  row.is_first = false;
  row.is_backwards = true;
  source.kernel.sweep(row);
}

}  // namespace

PageMemory::~PageMemory() {
  release();
}

PageMemory::PageMemory(PageMemory&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), count_(std::exchange(other.count_, 0)) {}

PageMemory& PageMemory::operator=(PageMemory&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(count_, other.count_);
  return *this;
}

void PageMemory::reserve(std::size_t count) {
  if (count <= count_) return;
  release();
  void* const memory = ::operator new (byte_count(count), std::align_val_t{kLargePage});
  // no harm where the system has no large pages
  (void)::madvise(memory, byte_count(count), MADV_HUGEPAGE);
  data_ = static_cast<std::int16_t*>(memory);
  count_ = count;
}

void PageMemory::release() noexcept {
  if (data_ != nullptr) ::operator delete (data_, std::align_val_t{kLargePage});
  data_ = nullptr;
  count_ = 0;
}

Census make_census(const GreyImage& image, StereoCensus kind, bool is_mirrored, std::size_t padding,
                   const Kernel& kernel) {
  const std::size_t radius = census_radius_px(kind);
  const PaddedImage source = padded(image, radius, is_mirrored);
  const Pairs pairs = make_pairs(kind, is_mirrored, source.stride);
  Census census;
  census.planes = pairs.first.size() / kPlaneBits;
  census.plane_stride = image.width + kLaneBlock + padding;
  census.bytes.resize(census.planes * census.plane_stride * image.height);
  for (std::size_t y = 0; y < image.height; ++y) {
    kernel.census({.centre = source.level.data() + (y + radius) * source.stride + radius,
                   .first = pairs.first.data(),
                   .second = pairs.second.data(),
                   .bits = pairs.first.size(),
                   .width = image.width,
                   .planes = census.bytes.data() + y * census.planes * census.plane_stride,
                   .plane_stride = census.plane_stride});
  }
  return census;
}

void check_volume(std::uint32_t width, std::uint32_t height, std::uint32_t disparities) {
  const std::uint64_t row = std::uint64_t{width} * padded_lanes(disparities);
  if (height <= kMaxCells / std::max<std::uint64_t>(row, 1)) return;
  throw Error({"stereo pair",
               std::to_string(width) + "x" + std::to_string(height) + " pixels with " +
                   std::to_string(disparities) + " disparities have too many costs",
               "at most " + std::to_string(kMaxCells),
               "search fewer disparities, or crop or shrink the images"});
}

void resize_volume(const GreyImage& image, std::uint32_t disparities, CostVolume& volume) {
  check_volume(image.width, image.height, disparities);
  volume.width = image.width;
  volume.height = image.height;
  volume.disparities = disparities;
  volume.lanes = padded_lanes(disparities);
  const std::uint64_t cells = std::uint64_t{image.width} * image.height * volume.lanes;
  volume.cost.reserve(cells);
  volume.sum.reserve(cells);
}

CostSource::CostSource(const GreyImage& left_image, const GreyImage& right_image,
                       const StereoOptions& matcher_options, const Kernel& inner_loops)
    : options(matcher_options),
      kernel(inner_loops),
      left(make_census(left_image, matcher_options.census, false, 0, inner_loops)),
      right(
          make_census(right_image, matcher_options.census, true,
                      padded_lanes(matcher_options.disparities) + matcher_options.min_disparity_px,
                      inner_loops)) {}

void fill_rows(const CostSource& source, std::size_t begin, std::size_t end, CostVolume& volume,
               CostWorkspace& workspace) {
  workspace.state.resize(2 * (volume.lanes + kStateGap) + kStateGap);
  BoxRows rows(source, volume, workspace);
  for (std::size_t y = begin; y < end; ++y) {
    if (y == begin) {
      rows.start(y);
    } else {
      rows.advance(y);
    }
    source.kernel.box(workspace.total.data(), volume.cost.data() + volume.offset(y), volume.width,
                      volume.lanes, source.options.box_px / 2);
    sweep_both_ways(source, y, volume, workspace);
  }
}

}  // namespace glidar::stereo
