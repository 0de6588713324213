// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/cloud_file.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace glidar {

// The JSON sidecars of clouds; docs/files/sidecars.md lists their fields.

/// The entry of a file that is about to be written to `path`.
SidecarEntry sidecar_entry(const CloudFile& job, const std::filesystem::path& path);

/// The sidecar at `path` of the files of one frame, at least one.
std::string sidecar_text(const SidecarContext& context, const Frame& frame,
                         std::span<const SidecarEntry> files, const std::filesystem::path& path);

/// What the frames of a run have in common, which is stored once, and the entries of frames.
struct RunSidecar {
  std::filesystem::path path;
  std::string json;
  std::string hash;                       ///< of the JSON but the command, hexadecimal
  std::vector<Pose> world_from_instance;  ///< in the first frame
  std::vector<std::string> frames = {};   ///< of files that have all frames
  std::uint64_t unlisted_frames = 0;      ///< after these

  /// Adds an entry, unless it or one before does not fit in what read_sidecar() reads.
  void add_frame(std::string entry);

 private:
  std::size_t bytes_ = 0;  ///< of the entries
  std::size_t values_ = 0;
};

RunSidecar run_sidecar(const SidecarContext& context, const Frame& first,
                       const std::filesystem::path& path);

/// The sidecar of a run, with the files that have all frames.
std::string sidecar_text(const RunSidecar& run, std::span<const SidecarEntry> files);

/// The number of points of a frame in a file that has all frames.
struct FramePoints {
  std::string file;
  std::uint64_t points = 0;
};

/// The entry of a frame in the sidecar of its run; boxes are in the axes of the cloud, and only
/// those with points are listed.
std::string frame_entry(const SidecarContext& context, const Frame& frame, const RunSidecar& run,
                        std::span<const FramePoints> points, const Pose& world_from_cloud);

/// The sidecar of the files of one frame of a run, in the folder of the run's.
std::string sidecar_text(const SidecarContext& context, const Frame& frame,
                         std::span<const SidecarEntry> files, const RunSidecar& run);

}  // namespace glidar
