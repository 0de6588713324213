// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/io/pictures/beam_picture.hpp>
#include <glidar/io/pictures/chart.hpp>
#include <glidar/io/pictures/colour_scale.hpp>
#include <glidar/io/pictures/picture.hpp>
#include <glidar/render/opengl/gl_object.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace glidar::app {

/// An eye that orbits a point, with the world's +z up. Positions are relative to an anchor in the
/// world, so that single precision suffices for scenes far from the world's origin.
struct Orbit {
  Eigen::Vector3d pivot_m = Eigen::Vector3d::Zero();  ///< from the anchor
  double yaw_rad = 0.0;                               ///< of the eye about the pivot, from +x
  double pitch_rad = 0.5;                             ///< of the eye above the pivot
  double distance_m = 1.0;
};

inline constexpr double kOrbitFov_rad = 0.8;  ///< vertical

/// Rotates by a drag in window heights, right and down.
void turn(Orbit& orbit, const Eigen::Vector2d& drag);
/// Moves the pivot with the drag, so that it stays under the pointer.
void pan(Orbit& orbit, const Eigen::Vector2d& drag);
/// Moves closer by steps of 10 %.
void zoom(Orbit& orbit, double steps);

/// The eye in the optical frame (x right, y down, z forward), from the anchor.
Pose anchor_from_eye(const Orbit& orbit);

/// OpenGL's matrix for points relative to the anchor; aspect is width / height.
Eigen::Matrix4f clip_from_anchor(const Orbit& orbit, double aspect);

/// The point closest to the eye among those displayed within `reach` heights of a position. Points
/// are relative to the anchor. The position is from -aspect to aspect (right) and -1 to 1 (up).
std::optional<std::size_t> point_at(const Orbit& orbit, std::span<const Eigen::Vector3f> points,
                                    const Eigen::Vector2d& place, double reach);

struct Sphere {
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
};

/// The sphere about the mean of the corners that contains them all; zero without corners.
Sphere sphere_around(std::span<const Eigen::Vector3d> corners_m);

/// Moves the eye so that the whole sphere is visible; the view direction stays. `aspect` is
/// width / height.
void frame_sphere(Orbit& orbit, const Sphere& anchored, double aspect);

/// Moves the eye away from its pivot until all points, relative to the anchor, are visible.
void zoom_out_to(Orbit& orbit, std::span<const Eigen::Vector3d> points, double aspect);

/// A view with the box, which may be empty, and the sensor in it. Both are relative to the anchor,
/// which is the middle of the box.
Orbit view_of_all(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& sensor_m, double aspect);

/// The field of view of a sensor: tangents of the angles from the boresight to its edges.
struct FieldOfView {
  SensorAxes axes;
  double left = 0.0;  ///< > 0
  double right = 0.0;
  double up = 0.0;
  double down = 0.0;
};

/// Empty for sensors that cannot be aimed: 360 degree scanners, lines, single beams.
std::optional<FieldOfView> field_of_view(const Beams& beams);

/// How much of an object is in the image, regardless of occlusion.
enum class Visibility : std::uint8_t { inside, partly, outside };

/// For the convex hull of the corners (world). `outside` is certain: all corners are behind
/// the sensor or beyond one edge of the image.
Visibility visibility(const FieldOfView& field, const Pose& world_from_sensor,
                      std::span<const Eigen::Vector3d> corners_m);

/// The sensor's pose after the smallest rotation that points the boresight at the point. Empty: the
/// sensor is at the point.
std::optional<Pose> aimed_at(const FieldOfView& field, const Pose& world_from_sensor,
                             const Eigen::Vector3d& point_m);

/// A pose of the sensor with all corners in its image: aimed at their centre, then moved back if
/// they do not fit. Empty: no change needed, or the sensor is between them.
std::optional<Pose> pose_to_show(const FieldOfView& field, const Pose& world_from_sensor,
                                 std::span<const Eigen::Vector3d> corners_m);

/// The mapping of numbers to colours.
enum class ColourMap : std::uint8_t { viridis, rainbow, grey };
inline constexpr std::array<std::string_view, 3> kColourMaps = {"viridis", "rainbow", "grey"};

/// The colour of a number from 0 (dark, or blue) to 1 (bright, or red), clamped.
Colour colour_of(ColourMap map, double t);

/// A vertex of a line, or a point, relative to the anchor, in the layout of the vertex buffer.
struct ColouredVertex {
  Eigen::Vector3f position_m;
  Colour colour;
  std::uint8_t opacity = 255;
};
static_assert(sizeof(ColouredVertex) == 16, "the layout of the vertex buffer");

/// Lines, two vertices each.
using Lines = std::vector<ColouredVertex>;

/// 1, 2 or 5 times a power of ten metres, about a tenth of `extent_m`.
double grid_spacing_m(double extent_m);

/// A horizontal grid around a point, `extent_m` to every side; its lines are at multiples of the
/// spacing from the anchor.
void add_grid(const Eigen::Vector3d& about_m, double extent_m, double spacing_m, Lines& lines);

/// Axes of this pose: x red, y green, z blue.
void add_axes(const Pose& anchor_from_frame, double length_m, Lines& lines);

/// The edges of boxes, 8 corners each: corner i ^ 1, i ^ 2 and i ^ 4 are the neighbours of corner
/// i.
void add_boxes(std::span<const Eigen::Vector3d> corners_m, Lines& lines);

/// The edges of the beams' frustum up to a range: the border of the beams' grid, and lines to it
/// from their origins.
void add_frustum(const Beams& beams, const Pose& anchor_from_sensor, double range_m, Lines& lines);

/// Parameters for drawing points and lines.
struct CloudView {
  int width = 1;  ///< pixels
  int height = 1;
  Eigen::Matrix4f clip_from_anchor = Eigen::Matrix4f::Identity();
  float point_size = 2.0F;  ///< pixels
};

/// Points and lines, drawn into a texture in the current context.
class CloudDrawing {
 public:
  CloudDrawing();

  void set_points(std::span<const ColouredVertex> points);
  void set_lines(std::span<const ColouredVertex> lines);
  /// Draws into the texture, whose first row is the bottom one.
  void draw(const CloudView& style);
  [[nodiscard]] GLuint texture() const { return picture_.name(); }

 private:
  /// Vertices in the device's memory.
  struct Corners {
    opengl::VertexArray arrays;
    opengl::Buffer buffer;
    GLsizei count = 0;
  };
  static void fill(std::span<const ColouredVertex> vertices, Corners& corners);
  void resize(int width, int height);

  opengl::Program program_;
  Corners points_;
  Corners lines_;
  opengl::Framebuffer frame_;
  opengl::GlTexture picture_;
  opengl::Renderbuffer depths_;
  int width_ = 0;
  int height_ = 0;
};

/// The displayed quantity of a measurement.
enum class Quantity : std::uint8_t { depth, range, intensity, normals, instance, status };
inline constexpr std::array<std::string_view, 6> kQuantities = {"depth",   "range",    "intensity",
                                                                "normals", "instance", "status"};

/// A measurement as colours, one per beam, with their meaning.
struct SensorPicture {
  std::vector<Colour> colours;      ///< rows x cols, row by row
  BeamPicture layout;               ///< where each beam is shown; all returns, one below the other
  ColourScale scale;                ///< of the quantities that have one
  std::vector<LegendEntry> legend;  ///< of the others
};

/// Beams without a return are grey, near ones bright. Normals are in the sensor's view: red right,
/// green up, blue towards the sensor; they need frame.ground_truth.normal.
void make_sensor_picture(const Frame& frame, const Beams& beams, const Scene& scene,
                         Quantity quantity, ColourMap map, SensorPicture& picture);

/// True for quantities with a colour map and a scale.
bool has_scale(Quantity quantity);

/// The unit of the scale: "m", or empty.
std::string_view unit_of(Quantity quantity);

/// The colour of a status.
Colour colour_of(Status status);

}  // namespace glidar::app
