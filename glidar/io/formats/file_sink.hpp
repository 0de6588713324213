// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/core/point_cloud.hpp>
#include <glidar/core/report.hpp>
#include <glidar/sensor/sensor.hpp>

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glidar {

enum class PcdEncoding : std::uint8_t { ascii, binary, binary_compressed };

/// The value that determines the colours of points in .bev.png and .view.png.
enum class ColourBy : std::uint8_t {
  height,
  range,
  intensity,
  ring,
  object_class,
  instance,
  radial_velocity
};

inline constexpr std::uint32_t kMinPictureSide =
    200;  ///< pixels; smaller pictures have no room for labels and a plot
inline constexpr std::uint32_t kMaxPictureSide = 8192;

/// Pictures of a cloud from above and in perspective.
struct CloudPictureOptions {
  ColourBy colour_by = ColourBy::height;
  std::uint32_t width = 1400;  ///< pixels, of the whole picture
  std::uint32_t height = 1000;
  std::optional<Eigen::Vector3d> eye_m = {};     ///< eye of the perspective, in the cloud's frame;
  std::optional<Eigen::Vector3d> target_m = {};  ///< empty: a view of most points
};

/// The names of ColourBy, in its order: height range intensity ring class instance radial_velocity.
std::span<const std::string> colour_by_names();

struct FileSinkOptions {
  PcdEncoding pcd = PcdEncoding::binary;
  bool ply_ascii = false;
  bool drop_invalid = false;  ///< point formats omit points without a return
  bool sidecar = true;        ///< write NAME.glidar.json for NAME.pcd and other files of that name
  std::string layout = {};    ///< of cloud_layouts(), for formats that take columns; empty: none
  std::string crs = {};       ///< of LAS files, as crs_text() takes it; empty: a local system
  double depth_png_units_per_m = 1000.0;  ///< 16-bit depth PNG: 1000 = millimetres
  CloudPictureOptions picture = {};
  ProgressCallback progress = {};  ///< of one file, by its points; not for images and NPZ
};

/// The command that writes a cloud, and its working folder; no arguments: none.
struct CommandRecord {
  std::vector<std::string> arguments = {};
  std::filesystem::path folder = {};
};

/// What a sidecar lists of a file.
struct SidecarEntry {
  std::string json;
  Pose world_from_cloud;
};

/// Contents of the sidecar other than the frame; must outlive the sink.
struct SidecarContext {
  const Scene& scene;
  const Sensor& sensor;
  const Beams& beams;
  std::string renderer;
  CommandRecord command = {};  ///< lets `glidar explain` repeat the measurement
  /// Input files and other outputs, which no file of the cloud may overwrite.
  std::span<const std::string> inputs = {};
};

/// One output format.
struct FileFormat {
  std::string suffix;       ///< ".pcd", ".depth.png" ... ; the longest match selects the format
  std::string description;  ///< for --help
  std::vector<std::string> columns;  ///< cloud columns that it requires
  bool takes_more = false;           ///< also stores all other columns of the cloud
  bool is_folder = false;            ///< the path is a folder, to which every frame adds its files
  /// Columns that it reads for some sensors and scenes (KITTI: the range to calibrate intensities,
  /// instance and class for labels).
  std::vector<std::string> optional_columns = {};
  bool reads_framebuffer = false;  ///< requires Frame::framebuffer
  bool reads_boxes = false;        ///< requires Frame::boxes
  bool is_survey = false;          ///< unless requested otherwise: in the world's axes, deskewed
  std::string missing = {};  ///< library without which this build cannot write it; empty: it can
};

/// All formats, for help and errors.
std::span<const FileFormat> file_formats();

/// The path of an output: for folder formats without trailing separators, which
/// shells append ("out.kitti/"). Throws Error as format_for() does.
std::filesystem::path output_path(const std::filesystem::path& path);

/// The format for a path by its suffix; trailing separators are ignored. Throws Error naming all
/// suffixes and the nearest one.
const FileFormat& format_for(const std::filesystem::path& path);

/// The suffixes of all formats, with spaces between.
std::string all_suffixes();

/// The suffixes of formats that store any column: ".pcd .ply .npz .csv .las .exr".
std::string suffixes_with_columns();

/// The axes of clouds in a format: `requested`, or by default those of the world for surveys, else
/// those of the sensor.
std::string frame_for(const FileFormat& format, const std::string& requested);

/// Whether the file of this name has the fields of a layout, and the suffixes of such files. Throws
/// Error as format_for() does.
bool takes_layout(const std::filesystem::path& path);
std::string suffixes_with_layouts();

/// Whether one file of this name can have all frames of a run with these options. Throws Error as
/// format_for() does.
bool takes_runs(const std::filesystem::path& path, const FileSinkOptions& options);

/// Whether a name has the suffix of a format.
bool has_format(const std::filesystem::path& path);

/// Throws the Error of a name that is not one of a file, nor has one of these other suffixes.
[[noreturn]] void refuse_suffix(const std::filesystem::path& path,
                                const std::vector<std::string>& others);

/// All columns that a format may read.
std::vector<std::string> needed_columns(const FileFormat& format);

/// True for formats that are plain text with these options and thus readable on a terminal.
bool is_text(const FileFormat& format, const FileSinkOptions& options);

/// True for formats that store boxes of objects with these options, themselves or in a sidecar.
bool has_boxes(const FileFormat& format, const FileSinkOptions& options);

/// Why a sensor of a rig has no output of a format.
struct Misfit {
  std::string reason = {};  ///< end of a sentence: "a camera has no rings ..."; empty: it has
  std::string remedy = {};
};

/// A depth image requires a sensor that looks ahead, a picture coloured by ring one with rings.
Misfit find_misfit(const FileFormat& format, const CloudPictureOptions& picture,
                   const Sensor& sensor, const Beams& beams);

/// NAME.glidar.json for NAME.pcd and NAME.depth.png. Throws Error as format_for() does.
std::filesystem::path sidecar_path(const std::filesystem::path& path);

/// Writes files in two steps, so that the files of several sinks appear together or not at all.
class FileSink {
 public:
  FileSink() = default;
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;
  virtual ~FileSink() = default;

  /// The files that a cloud is written to, as far as known in advance, the sidecar included; for a
  /// folder format the folder.
  [[nodiscard]] virtual std::vector<std::filesystem::path> files() const = 0;
  /// Writes all files of the cloud but the sidecar under temporary names. Throws Error, also when
  /// one of them is among the context's inputs; then no file remains.
  virtual void stage(const PointCloud& cloud, const Frame& frame) = 0;
  /// What the sidecar lists of the staged cloud; empty: it has none.
  [[nodiscard]] virtual const std::optional<SidecarEntry>& sidecar_entry() const = 0;
  /// Adds a file to the staged ones.
  virtual void stage_text(const std::filesystem::path& path, const std::string& text) = 0;
  /// Gives the staged files their names. Throws Error when the system refuses.
  virtual void commit() = 0;
  /// All steps, for an organised cloud, made from `frame`, with a sidecar of its own.
  virtual void write(const PointCloud& cloud, const Frame& frame) = 0;
};

/// One file of the clouds of all frames of a run, with the columns `stamp` and `frame`, and the
/// points of a frame in the order of time. It appears under its name when it is complete.
class RunFile {
 public:
  /// Throws Error like make_file_sink(). What the context refers to must outlive it.
  RunFile(const std::filesystem::path& path, const FileSinkOptions& options,
          const SidecarContext& context, Report report = {});
  RunFile(const RunFile&) = delete;
  RunFile& operator=(const RunFile&) = delete;
  ~RunFile();

  /// Adds the points of a frame, whose cloud has the column `stamp`, and which was measured with
  /// these beams. Returns their number. Throws Error also if the columns are others than before.
  std::uint64_t append(const PointCloud& cloud, const Frame& frame, const Beams& beams);
  /// Completes the file, which has no name yet, and returns what its sidecar lists.
  SidecarEntry finish();
  void stage_text(const std::filesystem::path& path, const std::string& text);
  void commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A sink that writes one file per cloud: to a temporary name in the same folder,
/// then renamed, so that a path has either the complete file or is unchanged. Throws Error at once
/// when the suffix or the layout is unknown or the folder does not exist. Warns through `report`
/// when the format's float32 moves a coordinate or depth by more than 0.1 mm.
std::unique_ptr<FileSink> make_file_sink(const std::filesystem::path& path,
                                         const FileSinkOptions& options,
                                         const SidecarContext& context, Report report = {});

/// Sends the same bytes to an open file descriptor, such as standard output, when they are
/// complete; without a sidecar. `name` has the format's suffix and appears in errors. Throws Error
/// like make_file_sink; commit() throws ClosedPipe when the reader has closed the pipe.
std::unique_ptr<FileSink> make_stream_sink(int descriptor, const std::filesystem::path& name,
                                           const FileSinkOptions& options,
                                           const SidecarContext& context, Report report = {});

}  // namespace glidar
