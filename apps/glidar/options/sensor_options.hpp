// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/config/sensor_options.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace glidar::app {

/// The sensor as given on the command line; empty: not given.
struct SensorFlags : SensorOptions {
  std::string file;
  std::string mode;
  std::optional<std::uint32_t> width;
  std::optional<std::uint32_t> height;
  std::optional<double> fov_deg;
  std::optional<double> fx;
  std::optional<double> fy;
  std::optional<double> cx;
  std::optional<double> cy;
  std::optional<double> near_m;
  std::optional<double> far_m;
  std::optional<double> ambient;
  std::optional<std::array<double, 3>> attenuation;  ///< constant, linear, quadratic
  bool cull_back_faces = false;
  bool ground_truth = false;
};

/// Runs `work`; its errors about a sensor's mode name the option.
template <class Work>
void with_mode_option(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    ErrorParts parts = error.parts();
    if (parts.where == "mode") parts.where = "--mode";
    throw Error(parts);
  }
}

class OptionGroup;

/// --calibration, see apply_calibration().
void add_calibration_option(const OptionGroup& group, std::vector<std::string>& files);
void add_sensor_options(CLI::App& command, SensorFlags& flags);

}  // namespace glidar::app
