// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/core/scene.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <apps/glidar/run/advice.hpp>
#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/prepared_scene.hpp>
#include <apps/viewer/view_drawing.hpp>

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace glidar::app {

/// A measurement to be done.
struct MeasureRequest {
  std::shared_ptr<const RenderFlags> flags;  ///< other flags open another scene
  std::size_t sensor_index = 0;              ///< index of the sensor among those of the scene
  std::vector<Pose> objects_moved = {};      ///< moved_from_world per instance; empty: none moved
  Pose sensor_moved = Pose::Identity();      ///< moved_from_world of the sensor and its rig
  std::uint32_t number = 0;                  ///< of the frame
  std::uint64_t seed = 1;
  bool has_noise = true;  ///< false: no random errors
};

bool operator==(const MeasureRequest& a, const MeasureRequest& b);

/// A measurement and its inputs.
struct Snapshot {
  MeasureRequest request;
  std::shared_ptr<const PreparedScene> prepared;
  std::shared_ptr<Simulator> simulator;  ///< without noise if requested
  std::shared_ptr<const Sensor> sensor;  ///< the simulator's
  std::shared_ptr<const Beams> beams;
  Motion motion;
  Frame frame;           ///< with normals
  double seconds = 0.0;  ///< duration of the measurement
};

/// Measures in its own thread, so that the window never waits. All functions return at once.
class MeasurementThread {
 public:
  /// The thread calls `wake` when there are new results.
  MeasurementThread(Console& console, std::function<void()> wake);
  ~MeasurementThread();
  MeasurementThread(const MeasurementThread&) = delete;
  MeasurementThread& operator=(const MeasurementThread&) = delete;

  /// Only the latest request is measured.
  void measure(const MeasureRequest& request);
  /// Traces an entry of this measurement; only the latest request counts.
  void explain(const MeasureRequest& request, std::size_t entry);
  /// Writes the outputs of this measurement.
  void save(const MeasureRequest& request, const FrameFileRequest& files);

  /// Results; traces, errors and messages are returned once.
  struct Results {
    std::shared_ptr<const Snapshot> snapshot;  ///< the latest; empty: none yet
    std::optional<std::string> trace;
    std::vector<std::string> errors;
    bool is_refused = false;            ///< the latest flags could not be opened
    std::vector<std::string> messages;  ///< of the library, and about written files
    std::string busy;                   ///< the current task; empty: none
  };
  /// Replaces all results that were taken before.
  void take(Results& results);

 private:
  struct OpenScene;

  void run();
  void do_one(std::unique_lock<std::mutex>& lock);
  std::function<void()> next_task();
  void open_for(const MeasureRequest& request);
  void select_sensor(std::size_t index);
  void prepare(const MeasureRequest& request, Snapshot& snapshot);
  void measure_now(const MeasureRequest& request);
  void explain_now(const MeasureRequest& request, std::size_t entry);
  void save_now(const MeasureRequest& request, FrameFileRequest files);
  std::shared_ptr<Snapshot> unused_snapshot();
  void add_message(std::string message);
  void show_busy(std::string_view task, double fraction_done);

  Console& console_;
  std::function<void()> wake_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_ending_ = false;
  std::optional<MeasureRequest> pending_;
  std::deque<std::function<void()>> saves_;
  std::function<void()> trace_task_;
  Results results_;
  // used by the thread only
  std::unique_ptr<OpenScene> open_scene_;
  std::shared_ptr<const RenderFlags> refused_;  ///< flags that could not be opened; not tried again
  std::vector<std::shared_ptr<Snapshot>> snapshots_;  ///< their memory is reused
  std::thread thread_;
};

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
