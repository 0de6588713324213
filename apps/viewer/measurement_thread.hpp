// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/prepared_scene.hpp>

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

}  // namespace glidar::app
