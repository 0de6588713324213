// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/depth_camera/stereo.hpp>
#include <glidar/depth_camera/stereo_kernel.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar::stereo {

/// Uninitialised memory in large pages where the system has them: half the time of a first match
/// would otherwise be spent on page faults.
class PageMemory {
 public:
  PageMemory() = default;
  ~PageMemory();
  PageMemory(PageMemory&& other) noexcept;
  PageMemory& operator=(PageMemory&& other) noexcept;
  PageMemory(const PageMemory&) = delete;
  PageMemory& operator=(const PageMemory&) = delete;

  /// Space for `count` elements; their values are unspecified afterwards. Throws std::bad_alloc.
  void reserve(std::size_t count);

  [[nodiscard]] std::int16_t* data() const { return data_; }

 private:
  void release() noexcept;

  std::int16_t* data_ = nullptr;
  std::size_t count_ = 0;
};

/// The census of an image in byte planes, each row plane after plane.
struct Census {
  std::size_t planes = 0;
  std::size_t plane_stride = 0;  ///< bytes between planes
  std::vector<std::uint8_t> bytes;

  [[nodiscard]] const std::uint8_t* row(std::size_t y) const {
    return bytes.data() + y * planes * plane_stride;
  }
};

/// Pixels beyond the edge of the image equal the nearest one of the image. A mirrored census has
/// column width - 1 - x in place of x, followed by `padding` unspecified columns.
Census make_census(const GreyImage& image, StereoCensus kind, bool is_mirrored, std::size_t padding,
                   const Kernel& kernel);

/// Costs of all pixels and disparities, and sums of path costs minus kSumOffset; each height x
/// width x lanes.
struct CostVolume {
  std::size_t width = 0;
  std::size_t height = 0;
  std::size_t disparities = 0;
  std::size_t lanes = 0;  ///< disparities, rounded up to kLaneBlock
  PageMemory cost;
  PageMemory sum;

  [[nodiscard]] std::size_t row_size() const { return width * lanes; }
  [[nodiscard]] std::size_t offset(std::size_t y) const { return y * row_size(); }
};

/// Throws Error when a pair of images of this size has too many costs for the memory.
void check_volume(std::uint32_t width, std::uint32_t height, std::uint32_t disparities);

/// Gives a volume the size of a pair, in the memory that it has if that is large enough. Throws
/// Error when the pair is too large.
void resize_volume(const GreyImage& image, std::uint32_t disparities, CostVolume& volume);

/// What the costs of rows are computed from.
struct CostSource {
  CostSource(const GreyImage& left_image, const GreyImage& right_image,
             const StereoOptions& matcher_options, const Kernel& inner_loops);

  const StereoOptions& options;
  const Kernel& kernel;
  Census left;
  Census right;  ///< mirrored
};

/// Memory of a thread.
struct CostWorkspace {
  std::vector<std::uint8_t> distances;  ///< a ring of rows of Hamming distances
  std::vector<std::int16_t> total;      ///< sums of these over the rows of the box
  std::vector<std::int16_t> state;      ///< of a sweep
};

/// Computes the costs of rows [begin, end), and the path costs along these rows.
void fill_rows(const CostSource& source, std::size_t begin, std::size_t end, CostVolume& volume,
               CostWorkspace& workspace);

/// What the tests of a pixel read.
struct PixelEvidence {
  std::uint32_t column = 0;
  std::uint32_t winner = 0;        ///< lane: disparity minus min_disparity_px
  std::uint32_t right_winner = 0;  ///< lane that the matched right pixel selects
  std::uint32_t rivals = 0;        ///< lanes further than 1 from the winner that cost hardly more
  std::uint32_t step_sum = 0;      ///< steps of grey levels in the window
  std::uint32_t saturated_pixels = 0;
  std::uint32_t window_pixels = 1;
  float next_disparity_px = -1.0F;  ///< of the next valid pixel on the right; negative: none
};

/// The tests one by one: true where the pixel passes.
bool is_inside(const PixelEvidence& pixel, const StereoOptions& options);
bool has_texture(const PixelEvidence& pixel, const StereoOptions& options);
bool is_unsaturated(const PixelEvidence& pixel);
bool is_in_range(const PixelEvidence& pixel, const StereoOptions& options);
bool is_unique(const PixelEvidence& pixel);
bool is_consistent(const PixelEvidence& pixel, const StereoOptions& options);

/// Whether the window of a match at the disparity of the next valid pixel on the right crosses the
/// edge of the right image.
bool is_beside_border(const PixelEvidence& pixel, const StereoOptions& options);

/// The first test that fails. Where the search has no unique, consistent winner beside the edge of
/// the right image, that edge is the cause.
StereoStatus classify(const PixelEvidence& pixel, const StereoOptions& options);

/// The lanes that rival the winner, from those of the whole row of costs that do, as the neighbours
/// of the winner do not count.
std::uint32_t without_neighbours(std::uint32_t rivals, std::uint32_t winner,
                                 const StereoOptions& options, const std::int16_t* sums);

/// The minimum between three summed costs, as an offset from the middle one, -0.5 to 0.5 px.
double subpixel_offset(StereoSubpixel curve, double below, double middle, double above);

/// offset + a_factor sin(2 pi offset)
double corrected_offset(double offset, double a_factor);

/// A disparity rounded to a multiple of 1 / steps_per_px.
double rounded_disparity(double disparity_px, std::uint32_t steps_per_px);

/// match_stereo() with the costs that lead to the result, whose memory `volume` keeps for the next
/// pair. Its sums are complete only if the run keeps costs. Throws Error as match_stereo() does.
StereoMatch match_pair(const GreyImage& left, const GreyImage& right, const StereoOptions& options,
                       const StereoRun& run, CostVolume& volume);

/// The evidence of a pixel of a match, computed again from complete sums.
PixelEvidence gather_evidence(const CostVolume& volume, const StereoMatch& match,
                              const GreyImage& left, const StereoOptions& options,
                              std::size_t pixel);

}  // namespace glidar::stereo
