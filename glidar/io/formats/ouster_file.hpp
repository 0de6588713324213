// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: the metadata JSON of Ouster sensors, flat (firmware before 2.4) or in
// sections.

#include <glidar/sensor/optics/spinning.hpp>

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace glidar {

struct OusterMetadata {
  Spinning spinning;               ///< the rows that are used
  std::vector<std::size_t> slots;  ///< of each channel, the row of packets
  std::size_t slot_count = 0;      ///< rows of packets
  std::vector<std::string> notes;  ///< defaults that were used, and what is not used
};

/// Reads the optics from a sensor's metadata. Values that old firmware does not state get the
/// defaults of the manufacturer's library (ouster-sdk, metadata.cpp). Throws Error with the key
/// that is missing or malformed.
OusterMetadata load_ouster_metadata(const std::filesystem::path& path);

/// The same from a text; `file` is where it comes from, for errors.
OusterMetadata parse_ouster_metadata(const std::string& text, const std::string& file);

/// The value of a key, at the top (flat layout) or in a section; null: there is none.
const nlohmann::json* find_ouster_value(const nlohmann::json& all, const char* key);

}  // namespace glidar
