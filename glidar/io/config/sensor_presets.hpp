// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/config/sensor_file.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// A name as names are compared: small letters, without '-', '_' and ' '.
std::string normalised_name(std::string_view name);

/// The element of `names` that is equal, else the one whose normalised name is; empty: none.
std::string match_name(const std::string& name, const std::vector<std::string>& names);

/// "did you mean A, B or C?" with the nearest names; if none is near, `otherwise`.
std::string nearest_names(const std::string& name, std::vector<std::string> names,
                          const std::string& otherwise);

/// Whether a file's name ends in .yaml or .yml.
bool is_yaml(const std::filesystem::path& path);

/// The YAML files of a folder, sorted; none if there is no such folder.
std::vector<std::filesystem::path> yaml_files(const std::filesystem::path& folder);

/// One value of a sensor file and where it comes from.
struct DatasheetEntry {
  std::string key;     ///< e.g. "optics.elevation_deg"
  std::string value;   ///< as written; long lists shortened
  std::string source;  ///< empty: not stated
  bool verified = true;
};

/// A sensor with the provenance of its numbers.
struct Datasheet {
  std::string name;  ///< of the file, without folder and ending, or of the variant
  Sensor sensor;
  std::vector<DatasheetEntry> entries;    ///< in the order of the file
  std::vector<std::string> aliases = {};  ///< further names
  std::vector<std::string> modes = {};    ///< in the order of the file
  std::string default_mode = {};          ///< empty: none
};

/// How many values of a sensor the manufacturer's documents back: data sheets, manuals, drivers and
/// factory calibrations. Names, types and kinds are no values.
struct ValueCount {
  std::size_t backed = 0;
  std::size_t total = 0;
};
ValueCount count_values(const Datasheet& sheet);
ValueCount count_values(std::span<const DatasheetEntry> entries);

/// Like load_sensor_file, with the sources that the file gives.
Datasheet load_datasheet(const SensorReference& reference);

/// A bundled sensor.
struct SensorPreset {
  std::string name;   ///< of the file, without folder and ending, or of the variant
  std::string title;  ///< the key `name` of its document
  SensorReference reference;
  std::vector<std::string> aliases;
  std::vector<std::string> modes;
  std::string default_mode;  ///< empty: none
};

/// The folder of the bundled sensor files: sensors/ of the source, share/glidar/sensors of an
/// installation, or that of the variable GLIDAR_SENSORS. Throws Error when there is none.
std::filesystem::path sensor_folder();

/// The bundled sensors, sorted by name. Each variant of a family is one. Throws Error when there is
/// no folder or a file is malformed.
std::vector<SensorPreset> sensor_presets();

/// Those whose name, alias or title contains the text; case, '-', '_' and ' ' do not count.
std::vector<SensorPreset> matching_presets(const std::string& text);

/// The preset of this name or alias; an exact name has precedence. Case, '-', '_' and ' ' do not
/// count.
std::optional<SensorPreset> preset_named(const std::string& name);

/// A path, or FILE#VARIANT for a variant of a family. A file whose own name contains '#' has
/// precedence. Throws Error when nothing follows the '#'.
SensorReference split_variant(const std::string& path);

/// The sensor given by name or path: a path if it has a folder or an ending .yaml or .yml, else the
/// name of a preset. FILE#VARIANT is a variant of a family. `mode` becomes part of the result.
/// Throws Error naming the nearest presets.
SensorReference find_sensor_file(const std::string& name_or_path, const std::string& mode = "");

}  // namespace glidar
