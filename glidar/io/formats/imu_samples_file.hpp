// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>
#include <glidar/sensor/imu.hpp>

#include <filesystem>
#include <span>
#include <string>

namespace glidar {

/// What the description beside a file of samples contains.
struct ImuDescription {
  std::string name;  ///< of the IMU on the rig
  Imu imu;
  ImuRun run;
  Pose rig_from_imu = Pose::Identity();
};

/// Whether a name ends with .imu.csv or .imu.npz.
bool is_imu_samples_path(const std::filesystem::path& path);

/// Both suffixes, for errors and help.
std::string imu_samples_suffixes();

/// The column names of a CSV file, separated by commas.
std::string imu_csv_header();

/// The description as JSON: the keys of the IMU, seed, start, gravity, scale and misalignment
/// matrices, turn-on biases and the columns.
std::string imu_description_json(const ImuDescription& description);

/// Writes all samples with their ground truth as CSV or NPZ, by suffix, and the description as
/// PATH.json; both appear together. `read` are files that must not be overwritten. Throws Error.
void write_imu_samples(const ImuSamples& samples, const ImuDescription& description,
                       const std::filesystem::path& path, std::span<const std::string> read = {});

}  // namespace glidar
