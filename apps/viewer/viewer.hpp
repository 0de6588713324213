// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/core/scene.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <apps/glidar/run/advice.hpp>
#include <apps/viewer/cloud_drawing.hpp>
#include <apps/viewer/measurement_thread.hpp>
#include <apps/viewer/orbit.hpp>
#include <apps/viewer/sensor_picture.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glidar::app {

/// The objects of a scene that keys, mouse and panels act on: one or all.
class Selection {
 public:
  /// Sets the scene. Selects its first object, unless the selection is kept and still exists.
  void begin(const Scene& scene, bool is_kept);
  /// Empty: all objects. An object that does not exist is ignored.
  void select(std::optional<std::size_t> object);

  /// Index of the selected instance; empty: all.
  [[nodiscard]] std::optional<std::size_t> object() const { return object_; }
  [[nodiscard]] bool includes(std::size_t object) const { return !object_ || *object_ == object; }

  /// Corners of the bounding boxes of the selected objects at the frame's time, in the world: 8 for
  /// each object with vertices.
  [[nodiscard]] std::vector<Eigen::Vector3d> corners_m(const Frame& frame) const;

 private:
  std::vector<Eigen::AlignedBox3d> boxes_m_;  ///< per instance, in the object's frame, scaled
  std::optional<std::size_t> object_;
};

/// How a measurement is displayed.
struct ViewStyle {
  Quantity quantity = Quantity::depth;
  ColourMap map = ColourMap::viridis;
  float point_size = 2.0F;  ///< pixels
  Orbit orbit;
  double aspect = 0.8;  ///< width / height of the cloud's view
  double grid_m = 1.0;  ///< spacing
};

/// The state of the viewer and its reactions to keys and mouse, independent of the window.
class Viewer {
 public:
  /// Starts loading the input named in `flags`.
  Viewer(const RenderFlags& flags, MeasurementThread& thread);

  // What is displayed.
  [[nodiscard]] const Snapshot* snapshot() const { return results_.snapshot.get(); }
  [[nodiscard]] const MeasureRequest& request() const { return request_; }
  [[nodiscard]] const SensorPicture& picture() const { return picture_; }
  /// A point per beam, relative to the anchor; NaN without a return.
  [[nodiscard]] const std::vector<Eigen::Vector3f>& points() const { return points_; }
  [[nodiscard]] const Lines& guides() const { return guides_; }
  [[nodiscard]] const FrameSummary& summary() const { return summary_; }
  [[nodiscard]] const std::string& busy() const { return results_.busy; }
  /// Whether the snapshot is that of the request; while time advances, whether there is one.
  [[nodiscard]] bool is_current() const {
    return snapshot() != nullptr && (snapshot()->request == request_ || next_frame_s().has_value());
  }
  [[nodiscard]] std::optional<std::size_t> picked() const { return picked_; }
  [[nodiscard]] bool is_playing() const { return is_playing_; }
  /// The objects that keys, mouse and panels act on.
  [[nodiscard]] const Selection& selection() const { return selection_; }
  /// Name of the selected object, or "all objects".
  [[nodiscard]] std::string selected_name() const;
  /// How much of the selected objects is in the sensor's image; `inside` if it has no edges.
  [[nodiscard]] Visibility selection_visibility() const { return visibility_; }
  [[nodiscard]] bool keeps_in_view() const { return keeps_in_view_; }
  /// Whether the sensor or an object moves.
  [[nodiscard]] bool is_moving() const;
  /// Increases with every change of points, image or guides.
  [[nodiscard]] std::uint64_t version() const { return version_; }

  ViewStyle style;
  std::string trace;                ///< trace of the picked entry; empty: none
  std::vector<std::string> errors;  ///< until the user closes them
  std::string message;              ///< about the latest action

  /// Takes new results; true if there are any.
  bool take_results();
  /// Updates images, points and guides after a change of `style`.
  void update_view();

  // Actions of the user.
  void type(unsigned letter);
  void open(const std::string& path);
  void use_sensor(const std::string& preset);
  void use_renderer(const std::string& kind);
  /// Shows another sensor of the rig, at the same time.
  void select_sensor(std::size_t index);
  void set_noise(bool is_on);
  void set_seed(std::uint64_t seed);
  void save();
  void reset();
  void toggle_play();
  /// Selects an object by its index; empty: all objects.
  void select(std::optional<std::size_t> object);
  /// Frames the selected objects in the cloud's view, and aims the sensor at them if its image
  /// does not contain them.
  void frame_selected();
  /// While on, aims the sensor whenever the centre of the selected objects leaves its image.
  void set_keeps_in_view(bool is_on);
  /// Rotates the selected objects about their centre; the drag is in heights of the sensor's image.
  void rotate_objects(const Eigen::Vector2d& drag);
  /// Moves the sensor towards the selected objects; a step is 1/20 of the distance.
  void step_sensor(double steps);
  void set_sensor_pose(const Pose& world_from_sensor);
  void set_object_pose(std::size_t object, const Pose& world_from_object);
  /// Marks an entry, selects the object that it hit, and traces it after every measurement; time
  /// stops.
  void pick(std::optional<std::size_t> entry);

  /// Advances the time while playing.
  void advance(double seconds);
  /// Requests a frame of the sequence.
  void show_frame(std::uint32_t number);
  /// Time until the next frame; empty: nothing moves.
  [[nodiscard]] std::optional<double> next_frame_s() const;

 private:
  void request_measurement(const RenderFlags& flags);
  void update();
  void show_snapshot(bool is_new_scene);
  void begin_scene();
  void begin_sensor();
  void update_visibility();
  void add_selection_box();
  void aim_if_hidden();
  [[nodiscard]] bool is_open() const;
  [[nodiscard]] double rate_hz() const;
  [[nodiscard]] Pose& moved_object(std::size_t object);
  void request_trace();
  [[nodiscard]] Eigen::Vector3d middle_m() const;

  MeasurementThread& measurements_;
  MeasureRequest request_;
  MeasurementThread::Results results_;
  SensorPicture picture_;
  std::vector<Eigen::Vector3f> points_;
  Lines guides_;
  Eigen::Vector3d anchor_m_ = Eigen::Vector3d::Zero();
  std::shared_ptr<const RenderFlags> shown_flags_;
  std::size_t shown_sensor_ = 0;
  Selection selection_;
  std::optional<FieldOfView> field_;  ///< of the displayed sensor
  Visibility visibility_ = Visibility::inside;
  bool keeps_in_view_ = false;
  std::optional<std::size_t> picked_;
  std::optional<MeasureRequest> traced_;  ///< the request whose trace is pending
  bool is_playing_ = true;
  double time_s_ = 0.0;
  FrameSummary summary_;
  std::uint64_t version_ = 0;
  std::uint32_t saved_ = 0;  ///< number of saved clouds
};

}  // namespace glidar::app
