// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/render_options.hpp>
#include <apps/glidar/run/console.hpp>
#include <glidar/simulate/setup.hpp>
#include <glidar/woods2016/framebuffer.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace glidar::app {

/// How the rig and all instances move.
struct RigMotion {
  Trajectory world_from_rig;
  std::vector<Trajectory> world_from_instance;
};

/// A sensor on the rig, ready to measure.
struct Mount {
  std::string name = {};  ///< empty: it is the only one
  std::uint32_t id = 0;   ///< its place in the scene file, which its random numbers depend on
  Sensor sensor;
  Pose rig_from_sensor = Pose::Identity();
  Beams beams = {};  ///< of the frame that it is turned to, at first frame 0
  Motion motion = {};
  std::uint32_t frames = 1;  ///< in the duration asked for
};

/// A measurement made ready: all that its options name, loaded, placed and aimed.
struct Session {
  Scene scene;
  std::vector<Mount> mounts;  ///< one, or those of the scene file's rig
  RigMotion motion;
  std::unique_ptr<Renderer> renderer;
  std::unique_ptr<Woods2016Camera>
      paper;                       ///< what --quantized-framebuffer measures with; else none
  std::vector<std::string> files;  ///< all that were read
};

/// Loads what the options name; `on_loaded` is called before the long work of preparing it to be
/// cast at. The console tells how far it is and gives advice. Throws Error.
void open(const RenderFlags& flags, const std::function<void()>& on_loaded, Console& console,
          Session& session);

/// What files and topics of this sensor are labelled with: its name on a rig of which none was
/// chosen by itself; else empty.
std::string label_of(const RenderFlags& flags, const Mount& mount);

/// The session's only sensor. Throws Error when there are several and none was chosen.
Mount& only_mount(Session& session);

/// How a sensor and all instances move.
Motion motion_of(RigMotion motion, const Mount& mount);

/// Turns to a frame of the sequence: its beams, number, stamp and seed.
void start_frame(const RenderFlags& flags, std::uint32_t number, Mount& mount, Frame& frame);

/// A sensor of the session as simulate() wants it; all must outlive it.
Setup setup_of(const Session& session, const Mount& mount, Console& console);

/// Tells advice as warnings.
void print_advice(const std::vector<std::string>& advice, Console& console);

}  // namespace glidar::app
