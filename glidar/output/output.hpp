// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/core/report.hpp>
#include <glidar/io/config/scene_file.hpp>
#include <glidar/io/formats/file_sink.hpp>
#include <glidar/motion/motion.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glidar {

enum class LivoxDataType : std::uint8_t;
enum class OusterProfile : std::uint8_t;

namespace ros {
enum class ImageTransport : std::uint8_t;
enum class TransformMode : std::uint8_t;
struct Driver;
}  // namespace ros

/// A frame of one of the sensors of a rig; what it refers to is valid during a call.
struct RigFrame {
  const Frame& frame;
  const Beams& beams;                              ///< with which it was measured
  std::size_t sensor = 0;                          ///< index in OutputRig::sensors
  std::uint64_t index = 0;                         ///< among its sensor's frames, for file names
  std::chrono::steady_clock::time_point due = {};  ///< when its pose was known
  std::shared_ptr<const Motion> motion = {};       ///< of its measurement; nullptr: not known
};

/// A destination of all frames of a run: files, a recording, a network or a viewer.
class Output {
 public:
  /// How often idle connections are served.
  static constexpr std::chrono::milliseconds kServeInterval{20};

  Output() = default;
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;
  virtual ~Output() = default;

  /// The ground truth that it reads of a sensor's frames.
  [[nodiscard]] virtual HitColumnMask hit_columns(std::size_t sensor) const = 0;
  /// Takes a frame, in the order of time. Throws Error.
  virtual void write(const RigFrame& frame) = 0;
  /// Called often, also between frames.
  virtual void serve() {}
  /// How often serve() is to be called.
  [[nodiscard]] virtual std::chrono::milliseconds serve_interval() const { return kServeInterval; }
  /// Call after the last frame: completes files, which appear under their names. Without it nothing
  /// of a recording remains.
  virtual void finish() = 0;
  /// The files that it has made: those of the last frame, or after finish() those of the recording.
  [[nodiscard]] virtual std::vector<std::filesystem::path> files() const { return {}; }
  /// What it wrote, in lines for the user; empty: nothing.
  [[nodiscard]] virtual std::string written_text() const;
};

/// The motion of a rig and of the instances of its scene.
struct RigMotion {
  Trajectory world_from_rig;
  std::vector<Trajectory> world_from_instance;
};

/// A sensor of a rig. Sensor and beams must outlive the outputs.
struct OutputSensor {
  std::string name = {};   ///< of its topics; empty: the only sensor
  std::string label = {};  ///< in the names of its files; empty: none
  std::uint32_t id = 0;
  const Sensor& sensor;
  const Beams& beams;  ///< of frame 0
  Pose rig_from_sensor = Pose::Identity();
};

/// What is measured. The scene must outlive the outputs.
struct OutputRig {
  const Scene& scene;
  std::vector<OutputSensor> sensors;
  /// At the times of stamps; empty: known only at the times of frames, by the frames' poses.
  std::optional<RigMotion> motion = {};
  std::vector<RigImu> imus = {};  ///< whose samples need the motion
  Eigen::Vector3d gravity_m_s2 = standard_gravity_m_s2();
  std::uint64_t seed = 1;                   ///< of the samples of IMUs
  std::int64_t start_ns = 0;                ///< of the samples of IMUs: the stamp of frame 0
  std::optional<std::int64_t> end_ns = {};  ///< of these; empty: the end of the last frame
  std::string renderer = {};                ///< for sidecars
  CommandRecord command = {};               ///< that repeats all frames; for sidecars
  std::vector<std::string> inputs = {};     ///< files that no output may replace
};

/// A driver whose messages a sensor has.
struct SensorDriver {
  std::string sensor_name;  ///< empty: all that the driver suits
  const ros::Driver* driver = nullptr;
};

/// The messages of ROS in bags and on networks.
struct MessageOptions {
  std::vector<SensorDriver> drivers = {};
  std::optional<ros::TransformMode> tf = {};  ///< empty: ground truth, or map for viewers
  std::string frame_prefix = {};
  bool imu_orientation = false;
  bool depth_in_mm = false;         ///< raw depth images are 16UC1
  ros::ImageTransport images = {};  ///< of cameras; by default raw
  bool has_colour = true;           ///< of cameras; the frames must have the column colour
  bool packet_topics = false;       ///< packets of Ouster and Velodyne sensors
};

/// How frames are written. An output ignores the options that it does not have.
struct OutputOptions {
  std::vector<std::string> columns = {};  ///< of clouds; empty: those that suit the output
  std::string frame = {};                 ///< axes of clouds; empty: by the format, see frame_for()
  bool deskew = false;                    ///< points as fired from where the sensor was
  bool per_frame = false;                 ///< a file for each frame also in formats of whole runs
  std::optional<OusterProfile> ouster_profile = {};  ///< of packets; empty: by the returns
  std::optional<LivoxDataType> livox_type = {};      ///< of points in packets; empty: in mm
  MessageOptions messages = {};
  FileSinkOptions sink = {};
};

/// The columns of a cloud unless others or a layout are chosen.
const std::vector<std::string>& default_columns();

/// Sets options by the names that the command line has: --as of all sensors, --ouster-profile,
/// --livox-data-type; empty and 0 change nothing. Throws Error.
void set_driver(const std::string& name, OutputOptions& options);
void set_ouster_profile(const std::string& name, OutputOptions& options);
void set_livox_type(int number, OutputOptions& options);

enum class OutputKind : std::uint8_t {
  frame_file,   ///< a file for each frame of each sensor
  imu_samples,  ///< the samples of every IMU
  // all frames of the run in one file or folder:
  bag,
  capture,
  osi_trace,
  kitti_folder,
};

/// A format of files, by its suffix.
struct OutputFormat {
  std::string suffix;
  OutputKind kind = OutputKind::frame_file;
  std::string description;   ///< one line
  std::string missing = {};  ///< library without which this build cannot write it; empty: it can
};

/// All formats of files: help, documentation, Python and errors have their lists from here.
std::span<const OutputFormat> output_formats();

/// The kind of output of this name. Throws Error naming all suffixes and the nearest one.
OutputKind output_kind(const std::filesystem::path& path);

/// The suffixes of a kind, with spaces between.
std::string suffixes_of(OutputKind kind);

/// The samples of all IMUs, in each of these files. Throws Error when there is no IMU, or when the
/// motion is not known.
std::unique_ptr<Output> open_imu_samples(std::vector<std::string> paths, const OutputRig& rig,
                                         const Report& report = {});

/// Throws Error if a layout or a coordinate reference system is given, but this output ignores it.
void check_options_used(const std::string& path_or_url, const OutputOptions& options);

/// Opens an output of the rig's frames: a file by its suffix (formats of one frame get a file
/// NAME_000007.png for each), or udp://HOST[:PORT[:PORT]], where the packets of its only sensor
/// with packets are sent as fast as frames are written. Warnings go to the report. Throws Error
/// when the name is not that of an output or is that of an input, or when it does not fit the
/// sensors.
std::unique_ptr<Output> open_output(const std::string& path_or_url, const OutputRig& rig,
                                    const OutputOptions& options = {}, const Report& report = {});

}  // namespace glidar
