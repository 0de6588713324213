// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/output/output.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace glidar {

/// The path that means standard output.
inline constexpr const char* kStandardOutput = "-";

/// Files of a frame.
struct FrameFileRequest : OutputOptions {
  std::vector<std::string> paths = {};  ///< "-": standard output
  std::string format = {};              ///< of standard output, without the dot; empty: not given
  std::string legacy_name = {};  ///< NAME.pcd and NAME.transform of the original GLIDAR; or empty
  std::string input = {};        ///< the model or scene; no output may replace it
  std::string option = {};       ///< that gave the paths, for errors; empty: none
  bool is_sequence = false;      ///< it is a frame of many, see numbered()
};

/// The format of one of the paths. Throws Error.
const FileFormat& format_of(const FrameFileRequest& request, const std::string& path);

/// Whether one of the paths is standard output; text for the user goes to standard error then.
bool writes_standard_output(const FrameFileRequest& request);

/// Whether there is any file.
bool has_outputs(const FrameFileRequest& request);

/// The same for one frame of a sequence: NAME_000007.png for NAME.png; folders take all frames, and
/// so do files in formats of whole runs unless requested otherwise (OutputOptions::per_frame).
/// Throws Error for standard output, which holds one cloud.
FrameFileRequest numbered(const FrameFileRequest& request, std::uint32_t frame);

/// Throws Error when a layout or a coordinate reference system is given, but no output takes one;
/// `has_bag`: there is a bag, which takes layouts.
void check_layout(const FrameFileRequest& request, bool has_bag);

/// The files of a frame, checked as far as possible before any work: suffix, folder, columns, no
/// name twice, not the input itself. Throws Error.
std::vector<std::filesystem::path> check_frame_files(const FrameFileRequest& request);

struct PlannedFile;

/// The files of every frame, and those of all frames. Those of a frame get their names together: if
/// one fails before that, no file of the frame exists, and no file of all frames has its points
/// unless adding them to a further one fails. If a later name is refused, the error lists the files
/// that exist.
class FrameFiles final : public Output {
 public:
  /// The files of a sensor with a label have it in their names: NAME_lidar.pcd. On a rig, outputs
  /// that do not fit a sensor, such as the depth image of a 360 degree LiDAR, are left out with a
  /// note. `is_numbered`: see numbered(). The report gets warnings, and progress if it has that.
  /// Throws Error if an output fits none of the sensors, or a file of the first frames is refused.
  FrameFiles(FrameFileRequest request, bool is_numbered, const OutputRig& rig, Report report);

  /// Whether a sensor has files.
  [[nodiscard]] bool has_files(std::size_t sensor) const { return has_outputs(of_sensor_[sensor]); }
  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor) const override;
  void write(const RigFrame& written) override;
  ~FrameFiles() override;
  /// Completes the files of all frames.
  void finish() override;
  /// Those of the last frame, without sidecars.
  [[nodiscard]] std::vector<std::filesystem::path> files() const override { return files_; }
  /// "wrote s_000000.png to s_000019.png (20 files)", and run_text().
  [[nodiscard]] std::string written_text() const override;
  /// "wrote s.pcd", the files of all frames; empty: none.
  [[nodiscard]] std::string run_text() const;

 private:
  struct Run;

  [[nodiscard]] SidecarContext context_of(std::size_t index, const Beams& beams) const;
  /// What is known of the run whose sidecar this is.
  Run& run_at(const std::filesystem::path& path, const SidecarContext& context, const Frame& frame);
  /// All files and sidecars of the frame, and then its points in files of all frames.
  void stage(const std::vector<PlannedFile>& files, const RigFrame& written,
             const SidecarContext& context);
  void append(const PlannedFile& file, const PointCloud& cloud, const RigFrame& written,
              const SidecarContext& context);
  /// One for the files of a frame with the same name, and one for the run.
  void stage_sidecars(const std::vector<PlannedFile>& files, const RigFrame& written,
                      const SidecarContext& context);
  /// The files of a frame, with their names.
  [[nodiscard]] FrameFileRequest request_of(std::size_t sensor, std::uint64_t index) const;

  FrameFileRequest request_;
  bool is_numbered_;
  OutputRig rig_;
  Report report_;
  std::vector<FrameFileRequest> of_sensor_;
  std::vector<std::filesystem::path> files_;
  std::filesystem::path first_;
  std::filesystem::path last_;
  std::uint64_t count_ = 0;  ///< files of frames, without sidecars
  std::map<std::filesystem::path, std::unique_ptr<Run>> runs_;  ///< by their sidecars
  std::map<std::filesystem::path, std::unique_ptr<RunFile>> run_files_;
  std::vector<std::filesystem::path> run_paths_;  ///< of files of all frames that are complete
};

}  // namespace glidar
