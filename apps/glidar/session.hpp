// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/console.hpp>
#include <apps/glidar/render_options.hpp>
#include <glidar/setup.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace glidar::app {

/// A measurement made ready: all that its options name, loaded, placed and aimed.
struct Session {
  Scene scene;
  Sensor sensor;
  Beams beams;  ///< of the frame that it is turned to, at first frame 0
  Motion motion;
  std::unique_ptr<Renderer> renderer;
  std::unique_ptr<PaperCamera> paper;  ///< what --render-target paper measures with; else none
  std::vector<std::string> files;      ///< all that were read
  std::uint32_t frames = 1;            ///< in the duration asked for
};

/// Loads what the options name; `on_loaded` is called before the long work of preparing it to be
/// cast at. The console tells how far it is and gives advice. Throws Error.
void open(const RenderFlags& flags, const std::function<void()>& on_loaded, Console& console,
          Session& session);

/// Turns to a frame of the sequence: its beams, number, stamp and seed.
void turn_to(const RenderFlags& flags, std::uint32_t number, Session& session, Frame& frame);

/// The session as simulate() wants it; both must outlive it.
Setup setup_of(const Session& session, Console& console);

/// Tells advice as warnings.
void tell(const std::vector<std::string>& advice, Console& console);

}  // namespace glidar::app
