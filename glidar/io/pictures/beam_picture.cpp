// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/pictures/beam_picture.hpp>

#include <glidar/core/beams.hpp>
#include <glidar/core/error.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/io/pictures/chart.hpp>
#include <glidar/io/pictures/colour_scale.hpp>
#include <glidar/io/pictures/picture.hpp>
#include <glidar/math/constants.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

namespace glidar {
namespace {

constexpr double kFullTurn_rad = 2.0 * std::numbers::pi;
constexpr double kEven_rad = 1e-3;  // tolerance of a row's elevation
constexpr double kEvenSteps = 0.5;  // tolerance of a column's azimuth, in steps

double wrapped(double angle_rad) {
  return angle_rad - kFullTurn_rad * std::round(angle_rad / kFullTurn_rad);
}

/// Azimuth and elevation of the beams of one return.
struct Angles {
  std::size_t rows;
  std::size_t cols;
  std::size_t first_col;  ///< the first column of the picture; the others follow cyclically
  std::vector<double> azimuth_rad;  ///< NaN for no beam
  std::vector<double> elevation_rad;
};

Angles angles_of(const Beams& beams, std::size_t first_beam) {
  const SensorAxes axes = axes_of(beams);
  Angles angles{beams.rows / beams.returns, beams.cols, 0, {}, {}};
  for (std::size_t i = first_beam; i < first_beam + beams.firings(); ++i) {
    angles.azimuth_rad.push_back(azimuth_rad(axes, beams.directions[i]));
    angles.elevation_rad.push_back(elevation_rad(axes, beams.directions[i]));
  }
  return angles;
}

/// The azimuth steps between columns in all rows; NaN next to a missing beam and at the end of a
/// row.
std::vector<double> steps_of(const Angles& angles) {
  std::vector<double> steps(angles.azimuth_rad.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    if ((i + 1) % angles.cols != 0)
      steps[i] = wrapped(angles.azimuth_rad[i + 1] - angles.azimuth_rad[i]);
  }
  return steps;
}

/// The median; NaN without numbers.
double median(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The typical step, and the column after which the azimuth jumps:
/// a sector in which the frame starts in the middle. The last column when there is no jump.
struct Steps {
  double mean_rad = 0.0;
  std::size_t jump_col = 0;
};

/// The step is 0 without beams.
Steps typical_steps(const Angles& angles) {
  const std::vector<double> steps = steps_of(angles);
  const double typical_rad = median(steps);
  Steps found{0.0, angles.cols - 1};
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (std::isnan(steps[i])) continue;
    if (std::abs(steps[i] - typical_rad) > std::abs(typical_rad)) {
      found.jump_col = i % angles.cols;
      continue;
    }
    sum += steps[i];
    ++count;
  }
  if (count > 0) found.mean_rad = sum / static_cast<double>(count);
  return found;
}

/// Rotates every row to begin with the column after the jump.
void begin_after(Angles& angles, std::size_t jump_col) {
  angles.first_col = (jump_col + 1) % angles.cols;
  for (std::vector<double>* values : {&angles.azimuth_rad, &angles.elevation_rad}) {
    for (std::size_t row = 0; row < angles.rows; ++row) {
      const auto begin = values->begin() + static_cast<std::ptrdiff_t>(row * angles.cols);
      std::rotate(begin, begin + static_cast<std::ptrdiff_t>(angles.first_col),
                  begin + static_cast<std::ptrdiff_t>(angles.cols));
    }
  }
}

/// A row's azimuth in column 0, extrapolated from its first beam, and its elevation.
struct Row {
  double azimuth_rad = 0.0;
  double elevation_rad = 0.0;
  std::size_t number = 0;
};

/// Empty unless the row has one elevation and even steps.
std::optional<Row> row_of(const Angles& angles, std::size_t number, double step_rad) {
  std::optional<Row> row;
  for (std::size_t col = 0; col < angles.cols; ++col) {
    const std::size_t i = number * angles.cols + col;
    if (std::isnan(angles.azimuth_rad[i])) continue;
    const double start_rad = angles.azimuth_rad[i] - step_rad * static_cast<double>(col);
    if (!row) row = Row{start_rad, angles.elevation_rad[i], number};
    const bool is_even =
        std::abs(wrapped(start_rad - row->azimuth_rad)) <= kEvenSteps * std::abs(step_rad);
    const bool is_level = std::abs(angles.elevation_rad[i] - row->elevation_rad) <= kEven_rad;
    if (!is_even || !is_level) return std::nullopt;
  }
  return row;
}

/// All rows, the highest first, their azimuths in column 0 within half a turn of the first's.
std::vector<Row> rows_of(const Angles& angles, double step_rad) {
  std::vector<Row> rows;
  for (std::size_t number = 0; number < angles.rows; ++number) {
    const std::optional<Row> row = row_of(angles, number, step_rad);
    if (!row) return {};
    rows.push_back(*row);
  }
  for (Row& row : rows)
    row.azimuth_rad = rows[0].azimuth_rad + wrapped(row.azimuth_rad - rows[0].azimuth_rad);
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Row& a, const Row& b) { return a.elevation_rad > b.elevation_rad; });
  return rows;
}

/// Pixel numbers increase to the right, where azimuths decrease; pixel 0 has the azimuth
/// `zero_rad`.
struct Extent {
  double zero_rad;
  std::int64_t first;  ///< the leftmost pixel
  std::int64_t cols;
  bool is_turn;
};

/// The pixel of a row's column 0.
std::int64_t pixel_of(const Row& row, double zero_rad, double size_rad) {
  return std::lround((zero_rad - row.azimuth_rad) / size_rad);
}

Extent extent_of(const std::vector<Row>& rows, double step_rad, std::size_t cols) {
  const double size_rad = std::abs(step_rad);
  const auto count = static_cast<std::int64_t>(cols);
  if (size_rad * (static_cast<double>(cols) + 1.0) >= kFullTurn_rad)
    return {std::numbers::pi, 0, count, true};
  const double zero_rad = rows.front().azimuth_rad;
  std::int64_t least = 0;
  std::int64_t most = 0;
  for (const Row& row : rows) {
    const std::int64_t pixel = pixel_of(row, zero_rad, size_rad);
    least = std::min(least, pixel);
    most = std::max(most, pixel);
  }
  const std::int64_t first = step_rad < 0.0 ? least : least - (count - 1);
  return {zero_rad, first, most - least + count, false};
}

/// Sets the beam of each pixel.
void place_beams(const Angles& angles, const std::vector<Row>& rows, const Extent& extent,
                 double step_rad, std::uint32_t first_beam, BeamPicture& picture) {
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const std::int64_t start =
        pixel_of(rows[r], extent.zero_rad, std::abs(step_rad)) - extent.first;
    for (std::size_t col = 0; col < angles.cols; ++col) {
      const auto along = static_cast<std::int64_t>(col);
      std::int64_t place = start + (step_rad < 0.0 ? along : -along);
      if (extent.is_turn) place = ((place % extent.cols) + extent.cols) % extent.cols;
      const std::size_t beam_col = (col + angles.first_col) % angles.cols;
      picture.beams.at(r * picture.cols + static_cast<std::size_t>(place)) =
          first_beam + static_cast<std::uint32_t>(rows[r].number * angles.cols + beam_col);
    }
  }
}

/// A grid of rows with one elevation each and even steps of azimuth, shifted so that all rows have
/// the same azimuth in a column, highest row on top; empty for other beams. A full rotation begins
/// behind the sensor; for a sector the picture covers all rows.
std::optional<BeamPicture> make_grid_picture(const Beams& beams, std::uint32_t first_beam) {
  Angles angles = angles_of(beams, first_beam);
  if (angles.rows < 2 || angles.cols < 2) return std::nullopt;
  const auto [step_rad, jump_col] = typical_steps(angles);
  const double size_rad = std::abs(step_rad);
  const bool is_more_than_a_turn =
      size_rad * (static_cast<double>(angles.cols) - 1.0) > kFullTurn_rad;
  if (step_rad == 0.0 || is_more_than_a_turn) return std::nullopt;
  begin_after(angles, jump_col);
  const std::vector<Row> rows = rows_of(angles, step_rad);
  if (rows.empty()) return std::nullopt;
  const Extent extent = extent_of(rows, step_rad, angles.cols);
  BeamPicture picture{.kind = BeamPicture::Kind::grid,
                      .rows = static_cast<std::uint32_t>(rows.size()),
                      .cols = static_cast<std::uint32_t>(extent.cols),
                      .beams = {},
                      .row_elevations_deg = {}};
  picture.beams.assign(std::size_t{picture.rows} * picture.cols, BeamPicture::kNoBeam);
  for (const Row& row : rows)
    picture.row_elevations_deg.push_back(kDegreesPerRadian * row.elevation_rad);
  place_beams(angles, rows, extent, step_rad, first_beam, picture);
  const double across_rad =
      extent.is_turn ? kFullTurn_rad : size_rad * static_cast<double>(extent.cols);
  const double left_rad = extent.zero_rad - size_rad * static_cast<double>(extent.first);
  picture.left = kDegreesPerRadian * (left_rad + (extent.is_turn ? 0.0 : 0.5 * size_rad));
  picture.right = picture.left - kDegreesPerRadian * across_rad;
  picture.top = picture.row_elevations_deg.front();
  picture.bottom = picture.row_elevations_deg.back();
  return picture;
}

constexpr double kLonger = 900.0;  // longer side of scattered pictures, pixels
constexpr double kShorter = 90.0;  // minimum of the shorter side, pixels

/// One beam in a scattered picture, in the units of its edges.
struct Mark {
  double across;
  double up;
  std::uint32_t beam;
  double range_m;  ///< infinite: no return
};

/// Sets the size of the picture. Scales are equal along both axes unless the picture would be too
/// narrow.
void size_picture(BeamPicture& picture) {
  const double width = std::abs(picture.right - picture.left);
  const double height = picture.top - picture.bottom;
  const double scale = kLonger / std::max(width, height);
  const auto pixels = [scale](double side) {
    return static_cast<std::uint32_t>(std::lround(std::max(scale * side, kShorter)));
  };
  picture.cols = pixels(width);
  picture.rows = pixels(height);
  picture.beams.assign(std::size_t{picture.rows} * picture.cols, BeamPicture::kNoBeam);
}

/// The dot size that leaves no gaps between evenly distributed beams, up to a maximum.
std::int64_t dot_pixels(const BeamPicture& picture, std::size_t beams) {
  constexpr double kMin = 3.0;
  constexpr double kMax = 15.0;
  const double share = static_cast<double>(picture.beams.size()) / static_cast<double>(beams);
  return std::lround(std::clamp(1.2 * std::sqrt(share), kMin, kMax));
}

/// A square of pixels, clipped to the picture.
void fill_dot(BeamPicture& picture, std::int64_t left, std::int64_t top, std::int64_t dot,
              std::uint32_t beam) {
  const auto cols = static_cast<std::int64_t>(picture.cols);
  const auto rows = static_cast<std::int64_t>(picture.rows);
  for (std::int64_t row = std::max<std::int64_t>(top, 0); row < std::min(top + dot, rows); ++row) {
    const std::int64_t begin = std::max<std::int64_t>(left, 0);
    const std::int64_t end = std::min(left + dot, cols);
    for (std::int64_t col = begin; col < end; ++col)
      picture.beams[static_cast<std::size_t>(row * cols + col)] = beam;
  }
}

/// Draws a dot for every beam, the farthest first, so that the nearest is visible.
void draw_marks(BeamPicture& picture, std::vector<Mark>& marks, std::int64_t dot) {
  std::stable_sort(marks.begin(), marks.end(),
                   [](const Mark& a, const Mark& b) { return a.range_m > b.range_m; });
  for (const Mark& mark : marks) {
    const double x = (mark.across - picture.left) / (picture.right - picture.left);
    const double y = (picture.top - mark.up) / (picture.top - picture.bottom);
    const bool is_inside = x >= 0.0 && x <= 1.0 && y >= 0.0 && y <= 1.0;
    if (!is_inside) continue;
    fill_dot(picture, static_cast<std::int64_t>(x * picture.cols) - dot / 2,
             static_cast<std::int64_t>(y * picture.rows) - dot / 2, dot, mark.beam);
  }
}

/// Numbers with a margin, and minimum of the shorter side, pixels `min_side` apart.
std::pair<double, double> edges_of(double low, double high, double min_side) {
  const double margin = std::max(0.03 * (high - low), 0.5 * (min_side - (high - low)));
  return {low - margin, high + margin};
}

BeamPicture make_angle_picture(const Beams& beams, std::span<const double> range_m,
                               std::uint32_t first) {
  const SensorAxes axes = axes_of(beams);
  std::vector<Mark> marks;
  for (std::uint32_t i = first; i < first + beams.firings(); ++i) {
    const Eigen::Vector3d& d = beams.directions[i];
    if (std::isnan(d.x())) continue;
    marks.push_back(
        {kDegreesPerRadian * azimuth_rad(axes, d), kDegreesPerRadian * elevation_rad(axes, d), i,
         std::isnan(range_m[i]) ? std::numeric_limits<double>::infinity() : range_m[i]});
  }
  BeamPicture picture{.kind = BeamPicture::Kind::angles, .beams = {}, .row_elevations_deg = {}};
  Eigen::AlignedBox2d box;
  for (const Mark& mark : marks) box.extend(Eigen::Vector2d(mark.across, mark.up));
  if (box.isEmpty()) box.extend(Eigen::Vector2d::Zero());
  constexpr double kMin_deg = 1.0;
  std::tie(picture.right, picture.left) = edges_of(box.min().x(), box.max().x(), kMin_deg);
  std::tie(picture.bottom, picture.top) = edges_of(box.min().y(), box.max().y(), kMin_deg);
  size_picture(picture);
  draw_marks(picture, marks, dot_pixels(picture, std::max<std::size_t>(marks.size(), 1)));
  return picture;
}

/// The scanner and its returns from above, without distant outliers.
BeamPicture make_top_picture(const Beams& beams, std::span<const double> range_m,
                             std::uint32_t first) {
  std::vector<Mark> marks;
  std::vector<double> x = {0.0};
  std::vector<double> y = {0.0};
  for (std::uint32_t i = first; i < first + beams.firings(); ++i) {
    if (std::isnan(range_m[i])) continue;
    Eigen::Vector3d at = range_m[i] * beams.directions[i];
    if (!beams.origins_m.empty()) at += beams.origins_m[i];
    marks.push_back({at.x(), at.y(), i, range_m[i]});
    x.push_back(at.x());
    y.push_back(at.y());
  }
  const ColourScale across = make_colour_scale(x, ColourScale::Start::zero);
  const ColourScale upright = make_colour_scale(y, ColourScale::Start::zero);
  BeamPicture picture{.kind = BeamPicture::Kind::top, .beams = {}, .row_elevations_deg = {}};
  const double min_side_m = marks.empty() ? 2.0 : 0.1 * std::max(across.span(), upright.span());
  std::tie(picture.left, picture.right) = edges_of(across.low, across.high, min_side_m);
  std::tie(picture.bottom, picture.top) = edges_of(upright.low, upright.high, min_side_m);
  size_picture(picture);
  constexpr std::int64_t kDot = 5;
  draw_marks(picture, marks, kDot);
  return picture;
}

/// True for LiDARs whose beams all have one elevation.
bool is_one_line(const Beams& beams) {
  constexpr double kLevel_rad = 1e-3;
  if (beams.rows != beams.returns) return false;
  const SensorAxes axes = axes_of(beams);
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Eigen::Vector3d& direction : beams.directions) {
    if (std::isnan(direction.x())) continue;
    const double elevation = elevation_rad(axes, direction);
    low = std::min(low, elevation);
    high = std::max(high, elevation);
  }
  return high - low <= kLevel_rad;
}

}  // namespace

BeamPicture make_image_picture(std::uint32_t rows, std::uint32_t cols,
                               std::uint32_t number_of_return) {
  return {.kind = BeamPicture::Kind::image,
          .rows = rows,
          .cols = cols,
          .beams = {},
          .first = number_of_return * rows * cols,
          .row_elevations_deg = {}};
}

BeamPicture make_beam_picture(const Beams& beams, std::span<const double> range_m,
                              std::uint32_t number_of_return) {
  const auto first = static_cast<std::uint32_t>(number_of_return * beams.firings());
  if (looks_along_z(beams))
    return make_image_picture(beams.rows / beams.returns, beams.cols, number_of_return);
  if (is_one_line(beams)) return make_top_picture(beams, range_m, first);
  if (std::optional<BeamPicture> grid = make_grid_picture(beams, first)) return *std::move(grid);
  return make_angle_picture(beams, range_m, first);
}

namespace {

constexpr double kLetters = 18.0;
constexpr std::size_t kWide = 1080;
constexpr std::size_t kTall = 720;
constexpr std::size_t kLeft = 90;  // space for the labels
constexpr std::size_t kTop = 50;
constexpr std::size_t kRight = 40;
constexpr std::size_t kBottom = 160;

/// The direction of a beam in degrees to the left and up, and its value on the colour scale.
struct PatternMark {
  double left_deg;
  double up_deg;
  double value;
};

/// The range of angles along one axis of the plot.
struct PatternSide {
  double low_deg = 0.0;
  double high_deg = 0.0;
  std::size_t pixels = 0;

  [[nodiscard]] double place(double deg) const {
    return (deg - low_deg) / (high_deg - low_deg) * static_cast<double>(pixels - 1);
  }
};

/// Stride of rows and columns of an image, so that dots do not overlap.
std::size_t stride_of(const Beams& beams) {
  constexpr std::size_t kMaxAcross = 64;
  const bool image = beams.times_ns.empty() && beams.rows > 1;
  return image ? std::max<std::size_t>(1, std::max(beams.rows, beams.cols) / kMaxAcross) : 1;
}

/// Without the darkest colours, which are invisible on the background.
Colour mark_colour(double t) {
  constexpr double kDarkest = 0.2;
  return viridis(kDarkest + (1.0 - kDarkest) * t);
}

double value_of(const Beams& beams, std::size_t i) {
  if (!beams.times_ns.empty()) return 1e-6 * beams.times_ns[i];  // milliseconds
  if (!beams.rings.empty()) return beams.rings[i];
  const std::size_t row = i / beams.cols;
  return static_cast<double>(row);
}

std::vector<PatternMark> marks_of(const Beams& beams) {
  const SensorAxes axes = axes_of(beams);
  std::vector<PatternMark> marks;
  const std::size_t step = stride_of(beams);
  for (std::size_t row = 0; row < beams.rows; row += step) {
    for (std::size_t col = 0; col < beams.cols; col += step) {
      const std::size_t i = row * beams.cols + col;
      const Eigen::Vector3d& d = beams.directions[i];
      if (std::isnan(d.x())) continue;
      marks.push_back({kDegreesPerRadian * azimuth_rad(axes, d),
                       kDegreesPerRadian * elevation_rad(axes, d), value_of(beams, i)});
    }
  }
  if (marks.empty()) throw Error({"picture of the beams", "the sensor has no beams"});
  return marks;
}

/// The range of one angle with a margin; a fixed range for a single line.
PatternSide side_of(const std::vector<PatternMark>& marks, double PatternMark::*angle) {
  const auto [low, high] = std::minmax_element(
      marks.begin(), marks.end(),
      [angle](const PatternMark& a, const PatternMark& b) { return a.*angle < b.*angle; });
  const double margin_deg = std::max(0.04 * ((*high).*angle - (*low).*angle), 0.5);
  return {(*low).*angle - margin_deg, (*high).*angle + margin_deg, 0};
}

/// Equal scales along both axes, unless one side is much longer.
void size_sides(PatternSide& across, PatternSide& upright) {
  constexpr double kMaxStretch = 4.0;
  const double width_deg = across.high_deg - across.low_deg;
  const double height_deg = upright.high_deg - upright.low_deg;
  const double scale = std::min(kWide / width_deg, kTall / height_deg);
  const double stretch = std::clamp(0.3 * kWide / (scale * height_deg), 1.0, kMaxStretch);
  across.pixels = static_cast<std::size_t>(std::max(scale * width_deg, 200.0));
  upright.pixels = static_cast<std::size_t>(std::max(scale * stretch * height_deg, 60.0));
}

void draw_axes(Picture& picture, const Box& plot, const PatternSide& across,
               const PatternSide& upright) {
  fill(picture, plot, kPlotGround);
  const PlotAxis azimuth{"azimuth", across.high_deg, across.low_deg,
                         true};  // left in the picture is left of the sensor
  const std::vector<AxisLabel> elevations =
      axis_labels({"", upright.high_deg, upright.low_deg, true}, static_cast<double>(plot.height),
                  2.0 * kLetters);
  draw_grid(picture, plot, axis_labels(azimuth, static_cast<double>(plot.width), 5.0 * kLetters),
            elevations);
  draw_across_axis(picture, plot, azimuth, kLetters);
  draw_upright_axis(picture, plot, "elevation", elevations, kLetters);
}

void draw_marks(Picture& picture, const std::vector<PatternMark>& marks, const Box& plot,
                const std::array<PatternSide, 2>& sides, const ColourScale& scale) {
  const std::size_t size = marks.size() < 20'000 ? 2 : 1;
  const auto& [across, upright] = sides;
  for (const PatternMark& mark : marks) {
    const auto right = static_cast<std::size_t>(std::lround(across.place(mark.left_deg)));
    const auto up = static_cast<std::size_t>(std::lround(upright.place(mark.up_deg)));
    fill(picture, {plot.x + plot.width - 1 - right, plot.y + plot.height - 1 - up, size, size},
         mark_colour(scale.fraction(mark.value)));
  }
}

/// Firing times and rings have no outliers: the scale shows all values.
ColourScale scale_of(const std::vector<PatternMark>& marks) {
  const auto [low, high] = std::minmax_element(
      marks.begin(), marks.end(),
      [](const PatternMark& a, const PatternMark& b) { return a.value < b.value; });
  return {.low = low->value, .high = high->value, .has_values = true};
}

}  // namespace

void write_pattern_picture(const Beams& beams, const std::filesystem::path& path) {
  const std::vector<PatternMark> marks = marks_of(beams);
  std::array sides = {side_of(marks, &PatternMark::left_deg), side_of(marks, &PatternMark::up_deg)};
  size_sides(sides[0], sides[1]);
  constexpr std::size_t kMinWidth = 360;  // for the colour bar
  const std::size_t width = std::max(sides[0].pixels, kMinWidth);
  const Box plot{kLeft + (width - sides[0].pixels) / 2, kTop, sides[0].pixels, sides[1].pixels};
  Picture picture = make_picture(kLeft + width + kRight, kTop + plot.height + kBottom, kCanvas);
  draw_axes(picture, plot, sides[0], sides[1]);
  const ColourScale scale = scale_of(marks);
  draw_marks(picture, marks, plot, sides, scale);
  const bool has_times = !beams.times_ns.empty();
  draw_colour_bar(picture, {kLeft, kTop + plot.height + 75, width, 0},
                  {has_times ? "firing time" : "ring", has_times ? "ms" : "", scale, mark_colour},
                  kLetters);
  AtomicFile file(path);
  write_png(picture, "directions of the beams", file);
  file.commit();
}

}  // namespace glidar
