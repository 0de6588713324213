// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <apps/glidar/options/information_options.hpp>
#include <apps/glidar/options/model_options.hpp>
#include <apps/glidar/options/motion_options.hpp>
#include <apps/glidar/options/output_options.hpp>
#include <apps/glidar/options/pose_options.hpp>
#include <apps/glidar/options/sensor_options.hpp>
#include <glidar/render/renderer.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace glidar::app {

/// A measurement as given on the command line.
struct RenderFlags {
  std::string input;
  ModelFlags model;
  SensorFlags sensor;
  PoseFlags pose;
  MotionFlags motion;
  std::string surface;  ///< of the whole model; empty: its own
  std::string mount;    ///< the only sensor of the rig that measures; empty: all
  OutputFlags output;
  InformationFlags information;
  RendererOptions renderer;
  std::string target = "float";  ///< what the renderer draws: float or paper
  std::uint64_t seed = 1;
  std::optional<double> duration_s;  ///< of a sequence of frames; empty: a single one
  bool quiet = false;
};

inline bool has_paper_target(const RenderFlags& flags) {
  return flags.target == "paper";
}

/// How the beams are cast, as the sidecar tells it.
std::string renderer_name(const RenderFlags& flags);

/// Adds MODEL and all options of `render`.
void add_render_flags(CLI::App& command, RenderFlags& flags);

}  // namespace glidar::app
