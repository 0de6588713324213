// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/pictures/picture.hpp>

#include <apps/viewer/view_drawing.hpp>
#include <apps/viewer/viewer.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glidar::app {

/// Rounds to so many decimals, half away from zero; never returns -0. Keeps non-finite values.
double rounded(double value, int decimals);

/// Removes the minus sign of every zero number: "-0.00" becomes "0.00". All numbers in the window
/// use this or rounded().
std::string without_negative_zeros(const std::string& text);

/// The rate of drawing.
struct FrameRate {
  double frames_per_s = 0.0;  ///< frames drawn, without idle time
};

/// The widgets beside the views; called between Window::begin() and end(), within an open window of
/// Dear ImGui. Each applies the user's input at once.
void show_controls(Viewer& viewer);
void show_status(const Viewer& viewer, const FrameRate& rate);
void show_errors(Viewer& viewer);
void show_trace(Viewer& viewer);

/// The scale or legend below the sensor's image.
void show_legend(const Viewer& viewer);

}  // namespace glidar::app

struct GLFWwindow;

namespace glidar::app {

/// Callbacks for keys and for files dropped on the window.
struct WindowEvents {
  std::function<void(unsigned)> on_letter;  ///< a Unicode character typed outside text fields
  std::function<void()> on_escape;
  std::function<void(const std::vector<std::string>&)> on_drop;
  std::function<void()> on_redraw;  ///< the window must be drawn again
};

/// Mouse input that the last frame takes into account.
struct MouseInput {
  int x = -1;  ///< pixels from the window's upper left corner; -1: the pointer was never inside
  int y = -1;
  unsigned buttons = 0;           ///< pressed buttons: 1 left, 2 right, 4 middle
  std::uint64_t wheel_steps = 0;  ///< since the window was opened
};

struct WindowSize {
  int width = 1280;  ///< pixels
  int height = 720;
};

/// RAII: the window library; one at a time, in the main thread.
class WindowSystem {
 public:
  /// Connects to the X11 display of DISPLAY, else to the Wayland display of WAYLAND_DISPLAY. Throws
  /// Error if there is neither.
  WindowSystem();
  ~WindowSystem();
  WindowSystem(const WindowSystem&) = delete;
  WindowSystem& operator=(const WindowSystem&) = delete;

  /// Ends a wait() in the main thread; from any thread.
  static void wake();
  /// Handles pending events without waiting.
  static void poll();
  /// Waits for an event, at most so many seconds; empty: without limit.
  static void wait(std::optional<double> seconds);
  /// Whether wait() also ends without input: a Wayland compositor answers every picture.
  static bool wakes_without_input();
};

/// A window with a context of OpenGL 3.3, current in the main thread while it lives, and panels by
/// Dear ImGui in it.
class Window {
 public:
  /// Throws Error if there is no context.
  Window(const std::string& title, const WindowSize& size, WindowEvents events);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  [[nodiscard]] bool is_closing() const;
  /// Whether the window is minimised or has no size.
  [[nodiscard]] bool is_hidden() const;
  /// Whether the graphics device lost the context and all its objects.
  [[nodiscard]] bool is_lost() const;
  /// The size in which mouse and panels count; with Wayland, the drawn image may have more pixels.
  [[nodiscard]] WindowSize size() const;
  [[nodiscard]] const MouseInput& mouse() const { return mouse_; }
  /// Whether input waits for the next frame: a key and a motion of the mouse take one each.
  [[nodiscard]] static bool has_pending_input();

  /// Panels are added between these two; end() draws them.
  void begin();
  void end();
  /// The drawn image, before show().
  [[nodiscard]] Picture picture() const;
  /// Displays the drawn image.
  void show();

 private:
  [[nodiscard]] WindowSize drawn_size() const;

  struct WindowDeleter {
    void operator()(GLFWwindow* window) const;
  };
  WindowEvents events_;
  MouseInput mouse_;
  std::unique_ptr<GLFWwindow, WindowDeleter> window_;
};

}  // namespace glidar::app

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
