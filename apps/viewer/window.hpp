// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/pictures/picture.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct GLFWwindow;

namespace glidar::app {

/// What the window hands on of the keyboard and of files dropped on it.
struct WindowEvents {
  std::function<void(unsigned)> on_letter;  ///< a character typed, Unicode; not into a text field
  std::function<void()> on_escape;
  std::function<void(const std::vector<std::string>&)> on_drop;
  std::function<void()> on_damage;  ///< the system asks for the window to be drawn again
};

/// Mouse input that the last picture takes into account.
struct MouseInput {
  int x = -1;  ///< pixels from the window's upper left corner; -1: the pointer was never there
  int y = -1;
  unsigned buttons = 0;           ///< pressed ones: 1 left, 2 right, 4 middle
  std::uint64_t wheel_steps = 0;  ///< since the window was opened
};

struct WindowSize {
  int width = 1280;  ///< pixels
  int height = 720;
};

/// The library of windows, ready for use; one at a time, in the main thread.
class WindowSystem {
 public:
  /// Throws Error that says what to do when there is no display.
  WindowSystem();
  ~WindowSystem();
  WindowSystem(const WindowSystem&) = delete;
  WindowSystem& operator=(const WindowSystem&) = delete;

  /// Ends a wait() in the main thread; from any thread.
  static void wake();
  /// Takes what has happened, without waiting.
  static void poll();
  /// Waits until something happens, at most so many seconds; empty: for ever.
  static void wait(std::optional<double> seconds);
};

/// A window with a context of OpenGL 3.3, current in the main thread while it lives, and panels by
/// Dear ImGui in it.
class Window {
 public:
  /// Throws Error that says what to install when there is no context.
  Window(const std::string& title, const WindowSize& size, WindowEvents events);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  [[nodiscard]] bool is_closing() const;
  /// Minimised or of no size: nothing is to be drawn.
  [[nodiscard]] bool is_hidden() const;
  /// The graphics device lost the context: nothing that was made in it is left.
  [[nodiscard]] bool is_lost() const;
  [[nodiscard]] WindowSize size() const;
  [[nodiscard]] const MouseInput& mouse() const { return mouse_; }
  void set_title(const std::string& title);

  /// Panels are made between these two; end() draws them.
  void begin();
  void end();
  /// What was drawn, before it is shown.
  [[nodiscard]] Picture picture() const;
  /// Shows what was drawn.
  void show();

 private:
  struct Closing {
    void operator()(GLFWwindow* window) const;
  };
  WindowEvents events_;
  MouseInput mouse_;
  std::unique_ptr<GLFWwindow, Closing> window_;
};

}  // namespace glidar::app
