// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/model/model.hpp>
#include <glidar/render/renderer.hpp>

#include <apps/glidar/options/cli_fwd.hpp>
#include <apps/glidar/options/motion_options.hpp>
#include <apps/glidar/options/output_options.hpp>
#include <apps/glidar/options/sensor_options.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace glidar::app {

/// --unit --up --centre --texture-folder --no-cache --cache-folder.
void add_model_options(CLI::App& command, ModelOptions& options);

class OptionGroup;

/// --fisher: the Fisher information of the sensor's pose.
struct FisherFlags {
  bool is_requested = false;
  std::optional<double> sigma_m = {};  ///< of ranges if the sensor has no noise
};

/// A measurement as given on the command line.
struct RenderFlags {
  std::string input;
  ModelOptions model;
  SensorFlags sensor;
  PoseFlags pose;
  MotionFlags motion;
  std::string surface;      ///< of the whole model; empty: its own
  std::string imu;          ///< preset or file of an IMU at the sensor; empty: not given
  std::string sensor_name;  ///< the only sensor of the rig that measures; empty: all
  OutputFlags output;
  FisherFlags fisher;
  RendererOptions renderer;
  bool quantized_framebuffer = false;
  std::uint64_t seed = 1;
  std::optional<double> duration_s;  ///< of a sequence of frames; empty: see is_sequence()
  bool quiet = false;
};

/// Whether there are numbered frames; else a single one.
inline bool is_sequence(const RenderFlags& flags) {
  return flags.duration_s || flags.motion.to;
}

/// The renderer of exact hits. With the quantized framebuffer it is auto, which has the hits of all
/// others and needs no OpenGL 4.3.
RendererOptions hit_renderer(const RenderFlags& flags);

/// The renderer as sidecars name it.
std::string renderer_name(const RenderFlags& flags);

/// --renderer --threads --graphics-device.
void add_run_options(CLI::App& command, RendererOptions& options, const std::string& heading);

void add_threads_option(const OptionGroup& group, RendererOptions& options);

/// Adds MODEL and all options of `render`.
void add_render_options(CLI::App& command, RenderFlags& flags);

}  // namespace glidar::app
