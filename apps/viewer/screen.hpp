// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/viewer/cloud_drawing.hpp>
#include <apps/viewer/panels.hpp>
#include <apps/viewer/window.hpp>

#include <cstdint>

namespace glidar::app {

/// The content of the window: controls, the sensor's image, the cloud, messages. The window's
/// context must outlive it.
class Screen {
 public:
  /// Draws all panels of the window, between Window::begin() and end().
  void show(Viewer& viewer, const WindowSize& size, const FrameRate& rate);

 private:
  void show_sensor_view(Viewer& viewer);
  void show_cloud_view(Viewer& viewer);
  void use_mouse_on_sensor(Viewer& viewer);
  void use_mouse_on_cloud(Viewer& viewer);
  void upload(const Viewer& viewer);
  void upload_picture(const SensorPicture& picture);
  void upload_points(const Viewer& viewer);
  void draw_cloud(const Viewer& viewer, int width, int height);

  CloudDrawing cloud_;
  opengl::GlTexture sensor_;
  std::uint64_t uploaded_ = 0;    ///< version of the viewer on the device
  std::size_t shown_one_of_ = 1;  ///< one of so many points is drawn
  CloudView drawn_;               ///< how the cloud's texture is drawn
  std::uint64_t drawn_version_ = 0;
};

}  // namespace glidar::app
