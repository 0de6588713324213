// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/optics/ray_table.hpp>
#include <glidar/sensor/sensor.hpp>

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace glidar {

/// A text table "Time/s,Azimuth/deg,Zenith/deg" (the Livox simulation plugin's scan_mode files), to
/// be played again and again. Throws Error naming file and line.
RayTable load_scan_csv(const std::filesystem::path& path);

/// An array of doubles or floats, N x 3 (directions) or N x 6 (origins in metres, directions), or
/// rows x cols x 3 or 6. Without times. Throws Error.
RayTable load_ray_npy(const std::filesystem::path& path);

/// The files that the optics were read from, and notes about these.
struct OpticsSources {
  std::vector<std::string> files;
  std::vector<std::string> notes;
};

/// Rays from a file.
struct RayTableKeys {
  static constexpr TypeInfo kType = RayTable::kType;
  std::string file;
  RayTable table;            ///< once read
  bool has_times = false;    ///< for reports, which have no table
  bool has_origins = false;  ///< the same for origins
};

/// A spinning sensor from the metadata that Ouster sensors provide.
struct OusterKeys {
  static constexpr TypeInfo kType = {"ouster", "an Ouster LiDAR, from its metadata file"};
  std::string file;
  Spinning spinning;
  std::vector<std::string> notes;  ///< once read
};

/// Optics that a calibration file may describe in part: a camera or a spinning sensor.
template <class Struct>
struct CalibratedKeys {
  static constexpr TypeInfo kType = Struct::kType;
  Struct optics;
  OpticsSources sources = {};  ///< once read
};
using SpinningKeys = CalibratedKeys<Spinning>;
using PinholeKeys = CalibratedKeys<Pinhole>;

/// The form of an alternative of Optics in files.
template <class Struct>
struct FileForm {
  using type = Struct;
};
template <>
struct FileForm<RayTable> {
  using type = RayTableKeys;
};
template <>
struct FileForm<Spinning> {
  using type = SpinningKeys;
};
template <>
struct FileForm<Pinhole> {
  using type = PinholeKeys;
};
template <class... Types>
std::variant<typename FileForm<Types>::type..., OusterKeys> file_form(std::variant<Types...>);

using OpticsKeys = decltype(file_form(std::declval<Optics>()));

/// Calibration files of a sensor: the values of two keys of a file.
struct CalibrationFiles {
  FieldInfo calibration;
  FieldInfo fire_times;  ///< a key of null: there is none
  std::array<std::string, 2> paths = {};
};

void visit_calibration_files(FieldVisitor& visitor, CalibrationFiles& files);

/// See apply_calibration(); errors have the place of the key, too.
void apply_calibration_files(const FieldVisitor& visitor, const CalibrationFiles& files,
                             Sensor& sensor);

/// The keys of optics, of a table only its size.
OpticsKeys optics_keys(const Optics& optics);

Optics optics_of(OpticsKeys keys);

OpticsSources sources_of(const OpticsKeys& keys);

void describe(OpticsKeys& keys, FieldVisitor& visitor);
void describe(RayTableKeys& keys, FieldVisitor& visitor);
void describe(OusterKeys& keys, FieldVisitor& visitor);
void describe(SpinningKeys& keys, FieldVisitor& visitor);
void describe(PinholeKeys& keys, FieldVisitor& visitor);

struct SensorKeys {
  Sensor sensor;  ///< its optics are set by readers only
  OpticsKeys optics;
  bool has_table = false;  ///< the sensor's optics are a RayTable, given beside the file
};

/// The keys of a sensor, for writers.
SensorKeys sensor_keys(const Sensor& sensor);

void describe(SensorKeys& keys, FieldVisitor& visitor);

}  // namespace glidar
