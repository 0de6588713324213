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

/// The origin of a cloud, as recorded in its sidecar.
struct Sidecar {
  std::filesystem::path path;
  std::string version;    ///< of the program
  CommandRecord command;  ///< its folder as an absolute path; no arguments: not recorded
  std::uint32_t frame = 0;
  std::size_t points = 0;                 ///< in the cloud
  std::size_t hits = 0;                   ///< of the frame
  std::string frame_hash;                 ///< see frame_hash()
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

/// Reads the sidecar of a cloud, CLOUD.json. Throws Error when it is missing or not
/// a sidecar.
Sidecar read_sidecar(const std::filesystem::path& cloud);

}  // namespace glidar
