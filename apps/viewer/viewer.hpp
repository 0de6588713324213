// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/advice.hpp>
#include <apps/viewer/framing.hpp>
#include <apps/viewer/guide_lines.hpp>
#include <apps/viewer/measuring.hpp>
#include <apps/viewer/orbit.hpp>
#include <apps/viewer/selection.hpp>
#include <apps/viewer/sensor_picture.hpp>

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glidar::app {

/// How a measurement is looked at.
struct Look {
  Quantity quantity = Quantity::depth;
  ColourMap map = ColourMap::viridis;
  float point_size = 2.0F;  ///< pixels
  Orbit orbit;
  double aspect = 0.8;  ///< width / height of the cloud's view
  double grid_m = 1.0;  ///< spacing
};

/// What is seen and what keys and mouse do to it; knows no window.
class Viewer {
 public:
  /// Starts to open what the flags name.
  Viewer(const RenderFlags& flags, Measuring& measuring);

  // What is shown.
  [[nodiscard]] const Snapshot* shot() const { return news_.shot.get(); }
  [[nodiscard]] const Ask& ask() const { return ask_; }
  [[nodiscard]] const SensorPicture& picture() const { return picture_; }
  /// One for each beam, relative to the anchor; NaN without a return.
  [[nodiscard]] const std::vector<Eigen::Vector3f>& points() const { return points_; }
  [[nodiscard]] const Lines& guides() const { return guides_; }
  [[nodiscard]] const FrameSummary& summary() const { return summary_; }
  [[nodiscard]] const std::string& busy() const { return news_.busy; }
  /// Whether the shot is what is requested; while time goes on, whether there is one.
  [[nodiscard]] bool is_current() const {
    return shot() != nullptr && (shot()->ask == ask_ || next_frame_s().has_value());
  }
  [[nodiscard]] std::optional<std::size_t> picked() const { return picked_; }
  [[nodiscard]] bool is_playing() const { return is_playing_; }
  /// The objects that keys, mouse and panels act on.
  [[nodiscard]] const Selection& selection() const { return selection_; }
  /// Name of the selected object, or "all objects".
  [[nodiscard]] std::string selected_name() const;
  /// How much of the selected objects is in the sensor's picture; `inside` where it has no edges.
  [[nodiscard]] Visibility selection_visibility() const { return visibility_; }
  [[nodiscard]] bool keeps_in_view() const { return keeps_in_view_; }
  /// Whether sensor or objects move by themselves.
  [[nodiscard]] bool is_moving() const;
  /// Grows with every change of what is drawn from points, picture and guides.
  [[nodiscard]] std::uint64_t version() const { return version_; }

  Look look;
  std::string story;                ///< of the picked entry; empty: none
  std::vector<std::string> errors;  ///< until the user has read them
  std::string message;              ///< the latest of what was done

  /// Takes what was measured since; true when there was anything.
  bool take_news();
  /// Works out anew what follows from `look`.
  void look_changed();

  // What the user does.
  void type(unsigned letter);
  void open(const std::string& path);
  void use_sensor(const std::string& preset);
  void use_renderer(const std::string& kind);
  /// Shows another sensor of the rig, at the same time.
  void use_mount(std::size_t index);
  void set_noise(bool is_on);
  void set_seed(std::uint64_t seed);
  void save();
  void reset();
  void toggle_play();
  /// Selects an object by its index; empty: all objects.
  void select(std::optional<std::size_t> object);
  /// Shows the selected objects in the cloud's view, and aims the sensor at them if its picture
  /// does not contain them.
  void frame_selected();
  /// While on, turns the sensor whenever the middle of the selected objects leaves its picture.
  void set_keeps_in_view(bool is_on);
  /// Turns the selected objects about their middle by a drag of so many heights of the sensor's
  /// picture.
  void turn_objects(const Eigen::Vector2d& drag);
  /// Moves the sensor towards the selected objects by steps of a twentieth of the distance.
  void step_sensor(double steps);
  void set_sensor_pose(const Pose& world_from_sensor);
  void set_object_pose(std::size_t object, const Pose& world_from_object);
  /// Marks an entry, selects the object that it hit, and has its story told, now and whenever it is
  /// measured anew; time stops.
  void pick(std::optional<std::size_t> entry);

  /// Lets time go on while it plays.
  void advance(double seconds);
  /// Asks for a frame of the sequence.
  void turn_to(std::uint32_t number);
  /// Seconds until the next frame is due; empty: nothing moves.
  [[nodiscard]] std::optional<double> next_frame_s() const;

 private:
  void ask_for(const RenderFlags& flags);
  void update();
  void show_shot(bool is_new_session);
  void begin_session();
  void begin_sensor();
  void look_for_selection();
  void add_selection_box();
  void keep_in_view();
  [[nodiscard]] bool is_open() const;
  [[nodiscard]] double rate_hz() const;
  [[nodiscard]] Pose& moved_object(std::size_t object);
  void tell_story();
  [[nodiscard]] Eigen::Vector3d middle_m() const;

  Measuring& measuring_;
  Ask ask_;
  Measuring::News news_;
  SensorPicture picture_;
  std::vector<Eigen::Vector3f> points_;
  Lines guides_;
  Eigen::Vector3d anchor_m_ = Eigen::Vector3d::Zero();
  std::shared_ptr<const RenderFlags> shown_flags_;
  std::size_t shown_mount_ = 0;
  Selection selection_;
  std::optional<FieldOfView> field_;  ///< of the sensor shown
  Visibility visibility_ = Visibility::inside;
  bool keeps_in_view_ = false;
  std::optional<std::size_t> picked_;
  std::optional<Ask> told_;  ///< whose story is asked for
  bool is_playing_ = true;
  double time_s_ = 0.0;
  FrameSummary summary_;
  std::uint64_t version_ = 0;
  std::uint32_t saved_ = 0;  ///< clouds so far
};

}  // namespace glidar::app
