// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/session.hpp>

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

/// What is to be measured.
struct Ask {
  std::shared_ptr<const RenderFlags> flags;  ///< another one: what it names is opened anew
  std::size_t mount = 0;                     ///< index of the sensor among the session's mounts
  std::vector<Pose> objects_moved = {};  ///< moved_from_world per instance; empty: none is moved
  Pose sensor_moved = Pose::Identity();  ///< moved_from_world of the sensor and its rig
  std::uint32_t number = 0;              ///< of the frame
  std::uint64_t seed = 1;
  bool has_noise = true;  ///< false: no random errors
};

bool operator==(const Ask& a, const Ask& b);

/// A measurement and what it is made with.
struct Snapshot {
  Ask ask;
  std::shared_ptr<const Session> session;
  std::shared_ptr<const Sensor> sensor;  ///< without its noise if so asked
  std::shared_ptr<const Beams> beams;
  Motion motion;
  Frame frame;           ///< with normals
  double seconds = 0.0;  ///< that it took
};

/// Measures in a thread of its own, so that a window never waits. All functions return at once.
class Measuring {
 public:
  /// `wake` is called, by that thread, whenever there is something new to take.
  Measuring(Console& console, std::function<void()> wake);
  ~Measuring();
  Measuring(const Measuring&) = delete;
  Measuring& operator=(const Measuring&) = delete;

  /// The latest ask counts; one that was not begun is forgotten.
  void measure(const Ask& ask);
  /// Tells how an entry of this measurement comes to be; likewise the latest counts.
  void explain(const Ask& ask, std::size_t entry);
  /// Writes what the flags name of this measurement.
  void save(const Ask& ask, const OutputFlags& outputs);

  /// What there is to know; what is new is told once.
  struct News {
    std::shared_ptr<const Snapshot> shot;  ///< the latest; empty: none yet
    std::optional<std::string> story;
    std::vector<std::string> errors;
    bool is_refused = false;            ///< the flags asked for last could not be opened
    std::vector<std::string> messages;  ///< of the library, and what was written
    std::string busy;                   ///< with what; empty: with nothing
  };
  /// Replaces what was taken before, shot and all.
  void take(News& news);

 private:
  struct Opened;

  void run();
  void do_one(std::unique_lock<std::mutex>& lock);
  std::function<void()> next_task();
  void open_for(const Ask& ask);
  void use_mount(std::size_t index);
  void prepare(const Ask& ask, Snapshot& shot);
  void measure_now(const Ask& ask);
  void explain_now(const Ask& ask, std::size_t entry);
  void save_now(const Ask& ask, const OutputFlags& outputs);
  std::shared_ptr<Snapshot> spare();
  void say(std::string message);
  void show_busy(std::string_view task, double fraction_done);

  Console& console_;
  std::function<void()> wake_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_ending_ = false;
  std::optional<Ask> wanted_;
  std::deque<std::function<void()>> saves_;
  std::function<void()> story_;
  News news_;
  // of the thread alone
  std::unique_ptr<Opened> opened_;
  std::shared_ptr<const RenderFlags> refused_;    ///< could not be opened; not tried again
  std::vector<std::shared_ptr<Snapshot>> shots_;  ///< whose memory is used again
  std::thread thread_;
};

}  // namespace glidar::app
