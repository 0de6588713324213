// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/io/formats/file_sink.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace glidar {

/// read_sidecar() refuses larger files.
inline constexpr std::size_t kMaxSidecarBytes = std::size_t{512} << 20U;

/// A frame of a cloud.
struct SidecarFrame {
  std::uint32_t number = 0;
  std::size_t points = 0;  ///< in the cloud
  std::string hash;        ///< see frame_hash()
};

/// The origin of a cloud, as recorded in its sidecar.
struct Sidecar {
  std::filesystem::path path;
  std::string version;               ///< of the program
  CommandRecord command;             ///< its folder as an absolute path; no arguments: not recorded
  std::vector<SidecarFrame> frames;  ///< at least one
  bool has_all_frames = false;       ///< of a run, with the points of each in order of time
  std::vector<std::string> model_hashes;  ///< one per instance; empty for built-in models
};

/// A hexadecimal hash of the measurement: status, range and intensity of every beam, and radial
/// velocities if they are measured.
std::string frame_hash(const Frame& frame);

/// All numbers of a sensor with these beams, as JSON, as in a sidecar.
std::string sensor_to_json(const Sensor& sensor, const Beams& beams);

/// A folder relative to a file, so that both can be moved together, and the inverse.
std::string relative_folder(const std::filesystem::path& file, const std::filesystem::path& folder);
std::filesystem::path resolve_folder(const std::filesystem::path& file, const std::string& seen);

/// The JSON list of the files of a frame in its sidecar that exist. "[]" if it is of another
/// measurement than `own`, the JSON of a new sidecar: its hash, time, sensor's pose or objects
/// differ. Throws Error.
std::string listed_files(const std::filesystem::path& sidecar, const std::string& own);

/// Reads the sidecar of a cloud, NAME.glidar.json of NAME.pcd, and that of its run if there is one.
/// Throws Error when one is missing or not a sidecar, or when it does not list the cloud.
Sidecar read_sidecar(const std::filesystem::path& cloud);

}  // namespace glidar
