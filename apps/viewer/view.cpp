// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/view.hpp>

#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>
#include <apps/glidar/run/console.hpp>
#include <apps/viewer/screen.hpp>
#include <glidar/core/error.hpp>
#include <glidar/core/report.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/pictures/picture.hpp>

#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace glidar::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kExamples =
    R"(Left: the sensor's image. Right: its point cloud, with the sensor's frustum, axes and a grid.
Keys: s saves the cloud (buffer.pcd and buffer.transform, or the files of -o and --legacy-output),
+ and - move the sensor, space pauses, r resets, f frames the selected object in both views, Esc
quits. Keys and mouse act on the selected object, initially the first one; select another in the
list or click one of its points. Drag on the left to rotate it, on the right to orbit the cloud. A
click on a point also explains its measurement. In scene files with a rig of sensors, select the
sensor in the list, or show one alone with --sensor-name. Drop a model or scene file to open it.
Examples:
  glidar view builtin:asteroid
  glidar view builtin:torus --object-rate 0,0.5,0.2
  glidar view builtin:box --sensor VLP-16 --eye 0,0,0
With your own files:
  glidar view rig.yaml
Without a display, for scripts:
  xvfb-run -a glidar view builtin:torus --screenshot view.png)";

struct ViewFlags {
  RenderFlags render;
  std::string screenshot;               ///< empty: none
  std::optional<std::uint32_t> frames;  ///< measured and drawn before it quits
  bool prints_state = false;
  WindowSize size;
};

/// Panels may need two more frames after an event to update their layout.
constexpr int kSettleFrames = 3;

/// Frames per second, averaged over about the last second of activity.
class FrameRateMeter {
 public:
  void tick() {
    const Clock::time_point now = Clock::now();
    const double step_s = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    constexpr double kIdle_s = 0.5;
    constexpr double kWeight = 0.1;
    if (step_s > kIdle_s) return;  // it was idle
    mean_s_ = mean_s_ == 0.0 ? step_s : (1.0 - kWeight) * mean_s_ + kWeight * step_s;
  }
  [[nodiscard]] FrameRate rate() const { return {mean_s_ > 0.0 ? 1.0 / mean_s_ : 0.0}; }

 private:
  Clock::time_point last_;
  double mean_s_ = 0.0;
};

/// The viewer in its window.
class ViewerWindow {
 public:
  /// Opens the window first, so that loading begins with standard error as it was.
  ViewerWindow(const ViewFlags& flags, MeasurementThread& measurements, Console& console)
      : flags_(flags),
        console_(console),
        window_(first_window()),
        screen_(std::make_unique<Screen>()),
        viewer_(flags.render, measurements) {}

  /// Draws and displays; stores the image of the window if `picture` is given.
  void draw(Picture* picture = nullptr);
  void run();
  /// Measures and draws frames, one after the other.
  void run_frames(std::uint32_t count);
  [[nodiscard]] std::uint64_t drawn() const { return drawn_; }
  [[nodiscard]] const Viewer& viewer() const { return viewer_; }

 private:
  [[nodiscard]] std::unique_ptr<Window> make_window();
  [[nodiscard]] std::unique_ptr<Window> first_window();
  void reopen_window();
  [[nodiscard]] WindowEvents events();
  void wait();
  bool take_results();
  void wait_for(std::uint32_t number);
  void print_state(bool is_hidden);

  const ViewFlags& flags_;
  Console& console_;
  FrameRateMeter frame_rate_;
  std::unique_ptr<Window> window_;
  std::unique_ptr<Screen> screen_;  ///< destroyed before the window, whose context it needs
  Viewer viewer_;
  bool is_quitting_ = false;
  int redraws_left_ = kSettleFrames;  ///< frames to draw until panels are up to date
  std::uint64_t drawn_ = 0;
  std::uint64_t keys_ = 0;  ///< letters typed
  bool was_hidden_ = false;
  bool is_moving_ = false;  ///< at the last wait
};

std::unique_ptr<Window> ViewerWindow::make_window() {
  return std::make_unique<Window>("GLIDAR: " + flags_.render.input, flags_.size, events());
}

std::unique_ptr<Window> ViewerWindow::first_window() {
  const SilencedLibraries silenced;
  return make_window();
}

void ViewerWindow::reopen_window() {
  screen_.reset();
  window_.reset();
  window_ = make_window();
  screen_ = std::make_unique<Screen>();
  redraws_left_ = kSettleFrames;
}

WindowEvents ViewerWindow::events() {
  return {.on_letter =
              [this](unsigned letter) {
                ++keys_;
                viewer_.type(letter);
              },
          .on_escape = [this] { is_quitting_ = true; },
          .on_drop =
              [this](const std::vector<std::string>& paths) {
                if (!paths.empty()) viewer_.open(paths.front());
                if (paths.size() > 1) viewer_.message = "opened the first of several files";
              },
          .on_redraw = [this] { redraws_left_ = kSettleFrames; }};
}

void ViewerWindow::draw(Picture* picture) {
  if (window_->is_lost()) {
    viewer_.errors.emplace_back("the graphics device was reset; the window was opened again");
    reopen_window();
  }
  window_->begin();
  screen_->show(viewer_, window_->size(), frame_rate_.rate());
  window_->end();
  if (picture != nullptr) *picture = window_->picture();
  window_->show();
  frame_rate_.tick();
  ++drawn_;
}

/// Waits for an event, or until the next frame of a motion is due.
void ViewerWindow::wait() {
  const std::optional<double> due_s = viewer_.next_frame_s();
  if (std::exchange(is_moving_, due_s.has_value()) && !due_s) redraws_left_ = kSettleFrames;
  if (redraws_left_ > 0) {
    WindowSystem::poll();
    return;
  }
  WindowSystem::wait(due_s);
  const bool is_input = !WindowSystem::wakes_without_input() || Window::has_pending_input();
  if (!due_s && is_input) redraws_left_ = kSettleFrames;
}

/// Prints errors in the terminal too.
bool ViewerWindow::take_results() {
  const std::size_t known = viewer_.errors.size();
  const bool is_new = viewer_.take_results();
  for (std::size_t i = known; i < viewer_.errors.size(); ++i) console_.error(viewer_.errors[i]);
  return is_new;
}

/// Lets scripts wait until the window shows the effect of their actions.
void ViewerWindow::print_state(bool is_hidden) {
  const bool is_known = is_hidden && was_hidden_;
  if (!flags_.prints_state || is_known || !viewer_.is_current()) return;
  was_hidden_ = is_hidden;
  const WindowSize size = window_->size();
  const MouseInput& mouse = window_->mouse();
  const std::optional<std::size_t> selected = viewer_.selection().object();
  const std::int64_t object = selected ? static_cast<std::int64_t>(*selected) : -1;
  print(
      "state: picture={} frame={} size={}x{} hidden={} x={} y={} buttons={} wheel={} keys={} "
      "object={} sensor={}\n",
      drawn_, viewer_.snapshot()->request.number, size.width, size.height, is_hidden ? 1 : 0,
      mouse.x, mouse.y, mouse.buttons, mouse.wheel_steps, keys_, object,
      viewer_.snapshot()->request.sensor_index);
  std::fflush(stdout);
}

void ViewerWindow::run() {
  Clock::time_point before = Clock::now();
  while (!is_quitting_ && !window_->is_closing()) {
    wait();
    viewer_.advance(seconds_since(std::exchange(before, Clock::now())));
    if (take_results()) redraws_left_ = std::max(redraws_left_, 1);
    if (window_->is_hidden()) {
      redraws_left_ = 0;
      print_state(true);
      continue;
    }
    if (redraws_left_ == 0) continue;
    draw();
    if (Window::has_pending_input()) redraws_left_ = std::max(redraws_left_, kSettleFrames);
    if (--redraws_left_ == 0) print_state(false);
  }
}

void ViewerWindow::wait_for(std::uint32_t number) {
  const auto is_there = [&] {
    return viewer_.snapshot() != nullptr && viewer_.snapshot()->request.number == number;
  };
  while (!is_there() && viewer_.errors.empty()) {
    WindowSystem::wait(std::nullopt);
    viewer_.take_results();
  }
  if (!viewer_.errors.empty()) throw std::runtime_error(viewer_.errors.front());
}

void ViewerWindow::run_frames(std::uint32_t count) {
  wait_for(0);
  for (std::uint32_t k = 0; k < count; ++k) {
    if (viewer_.is_moving()) {
      viewer_.show_frame(k);
      wait_for(k);
    }
    WindowSystem::poll();
    if (is_quitting_ || window_->is_closing()) return;
    draw();
  }
}

/// Opens the file of the screenshot early, so that a wrong name is reported before any work.
std::unique_ptr<AtomicFile> screenshot_file(const std::string& path) {
  if (path.empty()) return nullptr;
  if (path.ends_with(".png")) return std::make_unique<AtomicFile>(path);
  throw Error(
      {.where = "--screenshot", .found = "'" + path + "'", .allowed = "a name that ends in .png"});
}

int run(ViewFlags& flags) {
  if (!flags.screenshot.empty() && !flags.frames) flags.frames = 1;
  const std::unique_ptr<AtomicFile> screenshot = screenshot_file(flags.screenshot);
  Console console(flags.render.quiet);
  const WindowSystem windows;
  MeasurementThread measurements(console, WindowSystem::wake);
  ViewerWindow window(flags, measurements, console);
  if (!flags.frames) {
    window.run();
  } else {
    const Clock::time_point start = Clock::now();
    window.run_frames(*flags.frames);
    const double seconds = seconds_since(start);
    if (!flags.render.quiet) {
      print("{} frames in {:.2f} s: {:.1f} frames/s\n", *flags.frames, seconds,
            *flags.frames / seconds);
    }
  }
  if (screenshot) {
    Picture picture;
    for (int i = 0; i < kSettleFrames; ++i) window.draw(&picture);
    refuse_overwrite_of_inputs(window.viewer().snapshot()->prepared->files, flags.screenshot);
    write_png(picture, "the window of glidar view", *screenshot);
    screenshot->commit();
  }
  if (!flags.render.quiet) print("drew {} frames of the window\n", window.drawn());
  return kDone;
}

WindowSize parse_size(const std::string& text) {
  constexpr std::uint32_t kMin = 320;
  constexpr std::uint32_t kMax = 16384;
  const auto size = image_size(kMin, kMax)(text);
  return {static_cast<int>(size[0]), static_cast<int>(size[1])};
}

}  // namespace

Command add_view(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("view", "Show a model or scene as a sensor sees it, in a window");
  const auto flags = std::make_shared<ViewFlags>();
  command.footer(output_names_text() + kExamples);
  add_render_options(command, flags->render);
  const OptionGroup group(command, "Window");
  constexpr std::uint32_t kMaxFrames = 1'000'000;
  group.add("--window", "WxH", "Size, pixels [1280x720]", flags->size, parse_size);
  group.add("--screenshot", "FILE", "Write the window as a PNG, then quit", flags->screenshot);
  group.add("--frames", "N", "Quit after N frames of the sensor [screenshot: 1]", flags->frames,
            whole(1U, kMaxFrames));
  group.add_flag("--print-state", "Print a line whenever the window is up to date, for scripts",
                 flags->prints_state);
  return [flags] { return run(*flags); };
}

bool has_viewer() {
  return true;
}

}  // namespace glidar::app
