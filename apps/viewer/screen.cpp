// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/screen.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/files/unique_fd.hpp>

#include <epoxy/gl.h>
#include <imgui.h>
#include <apps/glidar/run/console.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

// after epoxy, which declares the functions of OpenGL
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui_internal.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace glidar::app {
namespace {

constexpr std::size_t kMaxMessage_bytes = 65536;
constexpr timeval kMaxAnswer{.tv_sec = 10, .tv_usec = 0};

/// Connects to the compositor; its error number, 0: connected.
int connect_to(const std::string& path, const UniqueFd& display) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) return ENAMETOOLONG;
  std::memcpy(address.sun_path, path.data(), path.size());
  setsockopt(display.get(), SOL_SOCKET, SO_RCVTIMEO, &kMaxAnswer, sizeof kMaxAnswer);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): the interface of sockets
  const auto* generic = reinterpret_cast<const sockaddr*>(&address);
  return connect(display.get(), generic, sizeof address) == 0 ? 0 : errno;
}

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, &bytes[at], sizeof word);
  return word;
}

// Objects of the Wayland protocol: the first, and two that has_seat() makes.
constexpr std::uint32_t kDisplay = 1;
constexpr std::uint32_t kRegistry = 2;
constexpr std::uint32_t kSyncDone = 3;

/// What a compositor lists.
struct Globals {
  bool has_seat = false;
  bool is_complete = false;
};

/// Reads whole messages and returns their size. By the Wayland protocol, "Wire Format": a word for
/// the object, one for size and number of the message, and the arguments: of a global its number,
/// the length of its interface's name, and the name.
std::size_t read_messages(std::string_view bytes, Globals& globals) {
  constexpr std::string_view kSeat = "wl_seat";
  std::size_t at = 0;
  while (bytes.size() - at >= 8 && !globals.is_complete) {
    const std::size_t size = word_at(bytes, at + 4) >> 16U;
    if (size < 8 || size > bytes.size() - at) return at;
    globals.is_complete = word_at(bytes, at) == kSyncDone;
    const bool is_global = word_at(bytes, at) == kRegistry && size >= 16 + kSeat.size();
    if (is_global && word_at(bytes, at + 12) == kSeat.size() + 1 &&
        bytes.substr(at + 16, kSeat.size()) == kSeat) {
      globals.has_seat = true;
    }
    at += size;
  }
  return at;
}

/// Whether the compositor has a seat; empty: it does not answer.
std::optional<bool> has_seat(const UniqueFd& display) {
  constexpr std::uint32_t kSize = 12U << 16U;
  const std::array<std::uint32_t, 6> requests = {kDisplay, kSize | 1U, kRegistry,   // get_registry
                                                 kDisplay, kSize,      kSyncDone};  // sync
  if (send(display.get(), requests.data(), sizeof requests, MSG_NOSIGNAL) != sizeof requests) {
    return std::nullopt;
  }
  Globals globals;
  std::string bytes;
  while (!globals.is_complete) {
    std::array<char, 4096> part{};
    const ssize_t count = recv(display.get(), part.data(), part.size(), 0);
    if (count <= 0 || bytes.size() > kMaxMessage_bytes) return std::nullopt;
    bytes.append(part.data(), static_cast<std::size_t>(count));
    bytes.erase(0, read_messages(bytes, globals));
  }
  return globals.has_seat;
}

/// The value of an environment variable; empty: none.
std::string variable(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// A variable and its value, or that it is not set, as in messages.
std::string variable_text(const char* name) {
  const std::string value = variable(name);
  return std::string(name) + (value.empty() ? " is not set" : " is '" + excerpt(value) + "'");
}

/// Why no window can open on the Wayland display of WAYLAND_DISPLAY; empty: one can. Without a
/// runtime folder or a socket libwayland prints messages, and without a seat, as of a compositor
/// without a screen, GLFW 3.4 crashes.
std::string missing_wayland() {
  if (!variable("WAYLAND_SOCKET").empty()) return "";  // a connection that exists
  const std::string name = variable("WAYLAND_DISPLAY");
  const std::string text = variable_text("WAYLAND_DISPLAY");
  const std::filesystem::path path =
      std::filesystem::path(variable("XDG_RUNTIME_DIR")) / (name.empty() ? "wayland-0" : name);
  std::error_code none;
  const bool is_there = path.is_absolute() && std::filesystem::is_socket(path, none);
  if (!is_there && name.empty()) return text;
  if (!path.is_absolute()) return text + ", but " + variable_text("XDG_RUNTIME_DIR");
  const std::string socket_text = "the socket '" + excerpt(path.string()) + "'";
  if (!is_there) return text + ", but there is no " + socket_text.substr(4);
  const UniqueFd display(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (const int error = connect_to(path, display); error != 0) {
    return text + ", but nothing serves " + socket_text + ": " + std::strerror(error);
  }
  const std::optional<bool> seat = has_seat(display);
  if (!seat) return text + ", but " + socket_text + " does not answer";
  if (*seat) return "";
  return text + ", but that display has no seat (keyboard and mouse), which GLFW needs";
}

/// The last error of GLFW.
std::string glfw_error() {
  const char* text = nullptr;
  const int code = glfwGetError(&text);
  return code == GLFW_NO_ERROR || text == nullptr ? "no reason given" : text;
}

// Hints of GLFW 3.4; earlier versions refuse them without effect.
constexpr int kPlatform = 0x00050003;
constexpr int kWayland = 0x00060003;
constexpr int kX11 = 0x00060004;
constexpr int kScaleFramebuffer = 0x0002200D;
constexpr int kLibdecor = 0x00053001;
constexpr int kDisableLibdecor = 0x00038002;

/// Whether this GLFW has the platform, "X11" or "Wayland": before 3.4, each library has one.
bool is_supported(std::string_view platform) {
  return std::string_view(glfwGetVersionString()).find(platform) != std::string_view::npos;
}

/// A platform of GLFW, and the variable that names its display.
struct Platform {
  std::string_view name;
  int hint;
  const char* variable;
  const char* package;  ///< of GLFW 3.3 for it, in Debian 12
  std::string missing;  ///< why it has no display; empty: it may have one
};

/// Connects to the display; returns why it failed, empty if it did not.
std::string connect(const Platform& platform) {
  const std::string display = variable_text(platform.variable);
  if (!is_supported(platform.name)) {
    if (variable(platform.variable).empty()) return display;
    return display + ", but GLFW " + glfwGetVersionString() + " has no support for " +
           std::string(platform.name) + " (Debian 12: install " + platform.package + ")";
  }
  if (!platform.missing.empty()) return platform.missing;
  glfwInitHint(kPlatform, platform.hint);
  glfwInitHint(kLibdecor, kDisableLibdecor);  // libwayland crashes after it is unloaded
  return glfwInit() == GLFW_TRUE ? "" : display + ": " + glfw_error();
}

/// Whether windows are on a Wayland display.
bool is_wayland() {
#if GLFW_VERSION_MAJOR == 3 && GLFW_VERSION_MINOR < 4
  return is_supported("Wayland");
#else
  return glfwGetPlatform() == kWayland;
#endif
}

/// The callbacks of a window.
WindowEvents& events_of(GLFWwindow* window) {
  return *static_cast<WindowEvents*>(glfwGetWindowUserPointer(window));
}

void on_key(GLFWwindow* window, int key, int /*scancode*/, int action, int /*mods*/) {
  if (key == GLFW_KEY_ESCAPE && action == GLFW_PRESS) events_of(window).on_escape();
}

void on_character(GLFWwindow* window, unsigned letter) {
  if (!ImGui::GetIO().WantTextInput) events_of(window).on_letter(letter);
}

void on_drop_files(GLFWwindow* window, int count, const char** paths) {
  events_of(window).on_drop({paths, paths + count});
}

void on_refresh(GLFWwindow* window) {
  events_of(window).on_redraw();
}

GLFWwindow* open_window(const std::string& title, const WindowSize& size, int api, int robustness) {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_CONTEXT_CREATION_API, api);
  glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, robustness);
  glfwWindowHint(GLFW_SAMPLES, 0);
  glfwWindowHint(kScaleFramebuffer, GLFW_FALSE);  // pictures of the window have its size
  return glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
}

/// With EGL, like the renderer's contexts, else with the display's API. Contexts that report their
/// loss are preferred.
GLFWwindow* open_any_window(const std::string& title, const WindowSize& size) {
  for (const int api : {GLFW_EGL_CONTEXT_API, GLFW_NATIVE_CONTEXT_API}) {
    for (const int robustness : {GLFW_LOSE_CONTEXT_ON_RESET, GLFW_NO_ROBUSTNESS}) {
      GLFWwindow* window = open_window(title, size, api, robustness);
      if (window != nullptr) return window;
    }
  }
  throw Error({.where = "glidar view",
               .found = "the display gives no context of OpenGL 3.3: " + glfw_error(),
               .remedy =
                   "install libgl1-mesa-dri and libegl1, which also render in software; or write "
                   "a picture without a window: glidar render MODEL -o picture.png"});
}

}  // namespace

WindowSystem::WindowSystem() {
  const SilencedLibraries silenced;
  // X11 first, also below a desktop with Wayland: that is the display of xvfb-run.
  const std::string no_x11 = variable("DISPLAY").empty() ? variable_text("DISPLAY") : "";
  const std::string x11 = connect({"X11", kX11, "DISPLAY", "libglfw3", no_x11});
  if (x11.empty()) return;
  const std::string wayland =
      connect({"Wayland", kWayland, "WAYLAND_DISPLAY", "libglfw3-wayland", missing_wayland()});
  if (wayland.empty()) return;
  throw Error({.where = "glidar view",
               .found = "there is no display to open a window on: " + x11 + "; " + wayland,
               .remedy =
                   "run it in a desktop session or with 'xvfb-run -a glidar view ...', or write "
                   "a picture without a window: glidar render MODEL -o picture.png"});
}

WindowSystem::~WindowSystem() {
  glfwTerminate();
}

void WindowSystem::wake() {
  glfwPostEmptyEvent();
}

void WindowSystem::poll() {
  glfwPollEvents();
}

void WindowSystem::wait(std::optional<double> seconds) {
  if (!seconds) return glfwWaitEvents();
  if (*seconds > 0.0) return glfwWaitEventsTimeout(*seconds);
  glfwPollEvents();
}

bool WindowSystem::wakes_without_input() {
  constexpr int kKnowsInput = 18700;  // see Window::has_pending_input()
  return IMGUI_VERSION_NUM >= kKnowsInput && is_wayland();
}

void Window::WindowDeleter::operator()(GLFWwindow* window) const {
  glfwDestroyWindow(window);
}

Window::Window(const std::string& title, const WindowSize& size, WindowEvents events)
    : events_(std::move(events)), window_(open_any_window(title, size)) {
  GLFWwindow* window = window_.get();
  glfwMakeContextCurrent(window);
  // A Wayland compositor lets the buffers of a hidden window wait for ever.
  glfwSwapInterval(is_wayland() ? 0 : 1);
  glfwSetWindowUserPointer(window, &events_);
  glfwSetKeyCallback(window, on_key);
  glfwSetCharCallback(window, on_character);
  glfwSetDropCallback(window, on_drop_files);
  glfwSetWindowRefreshCallback(window, on_refresh);
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // writes no file
  ImGui::GetIO().ConfigWindowsMoveFromTitleBarOnly = true;
  ImGui::StyleColorsDark();
  float scale = 1.0F;
  glfwGetWindowContentScale(window, &scale, nullptr);
  scale *=
      static_cast<float>(this->size().width) / static_cast<float>(std::max(1, drawn_size().width));
  ImGui::GetIO().FontGlobalScale = scale;
  ImGui::GetStyle().ScaleAllSizes(scale);
  ImGui_ImplGlfw_InitForOpenGL(window, true);  // also calls the callbacks set above
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

Window::~Window() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

bool Window::is_closing() const {
  return glfwWindowShouldClose(window_.get()) == GLFW_TRUE;
}

bool Window::is_hidden() const {
  const WindowSize now = size();
  return now.width == 0 || now.height == 0 ||
         glfwGetWindowAttrib(window_.get(), GLFW_ICONIFIED) == GLFW_TRUE;
}

bool Window::is_lost() const {
  const bool can_tell = epoxy_gl_version() >= 45 || epoxy_has_gl_extension("GL_ARB_robustness") ||
                        epoxy_has_gl_extension("GL_KHR_robustness");
  return can_tell && glGetGraphicsResetStatus() != GL_NO_ERROR;
}

bool Window::has_pending_input() {
#if IMGUI_VERSION_NUM >= 18700
  return !ImGui::GetCurrentContext()->InputEventsQueue.empty();
#else
  return false;  // all input takes effect in one frame
#endif
}

WindowSize Window::size() const {
  WindowSize now;
  glfwGetWindowSize(window_.get(), &now.width, &now.height);
  return now;
}

WindowSize Window::drawn_size() const {
  WindowSize now;
  glfwGetFramebufferSize(window_.get(), &now.width, &now.height);
  return now;
}

void Window::begin() {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsMousePosValid(&io.MousePos)) {
    mouse_.x = static_cast<int>(io.MousePos.x);
    mouse_.y = static_cast<int>(io.MousePos.y);
  }
  mouse_.buttons = 0;
  for (unsigned button = 0; button < 3; ++button) {
    if (io.MouseDown[button]) mouse_.buttons |= 1U << button;
  }
  if (io.MouseWheel != 0.0F) ++mouse_.wheel_steps;
}

void Window::end() {
  ImGui::Render();
  const WindowSize now = drawn_size();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, now.width, now.height);
  glDisable(GL_SCISSOR_TEST);
  glClearColor(0.07F, 0.07F, 0.08F, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Window::show() {
  glfwSwapBuffers(window_.get());
}

Picture Window::picture() const {
  const WindowSize now = drawn_size();
  const auto width = static_cast<std::size_t>(now.width);
  const auto height = static_cast<std::size_t>(now.height);
  Picture picture = make_picture(width, height, {});
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  glReadBuffer(GL_BACK);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, now.width, now.height, GL_RGB, GL_UNSIGNED_BYTE, picture.pixels.data());
  for (std::size_t row = 0; row < height / 2; ++row) {  // OpenGL has the first row at the bottom
    Colour* const lower = &picture.pixels[row * width];
    std::swap_ranges(lower, lower + width, &picture.pixels[(height - 1 - row) * width]);
  }
  return picture;
}

}  // namespace glidar::app

namespace glidar::app {
namespace {

constexpr ImU32 kMarkColour = IM_COL32(255, 60, 200, 255);

constexpr ImGuiWindowFlags kFixed =
    ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
    ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoSavedSettings;

struct Area {
  float x;
  float y;
  float width;
  float height;
};

/// RAII: a panel at a fixed position.
class Panel {
 public:
  Panel(const char* title, const Area& area, ImGuiWindowFlags more = 0) {
    ImGui::SetNextWindowPos(ImVec2(area.x, area.y));
    ImGui::SetNextWindowSize(ImVec2(area.width, area.height));
    ImGui::Begin(title, nullptr, kFixed | more);
  }
  ~Panel() { ImGui::End(); }
  Panel(const Panel&) = delete;
  Panel& operator=(const Panel&) = delete;
};

/// Whether the last item was clicked with the left button, without a drag.
bool is_clicked() {
  constexpr float kStill = 4.0F;  // pixels of motion within a click
  const ImVec2 moved = ImGui::GetMouseDragDelta(ImGuiMouseButton_Left, 0.0F);
  return ImGui::IsItemDeactivated() && ImGui::IsMouseReleased(ImGuiMouseButton_Left) &&
         std::abs(moved.x) <= kStill && std::abs(moved.y) <= kStill;
}

/// The motion of the mouse since the last frame in heights of the last item, while this button
/// drags it.
Eigen::Vector2d dragged(ImGuiMouseButton button) {
  if (!ImGui::IsItemActive() || !ImGui::IsMouseDragging(button)) return Eigen::Vector2d::Zero();
  const ImVec2 by = ImGui::GetIO().MouseDelta;
  const double height = std::max(1.0F, ImGui::GetItemRectSize().y);
  return {by.x / height, by.y / height};
}

/// The area of the sensor's image, as large as fits. Pixels are square, except that the rows of
/// wide scanner images are stretched.
Area fit_picture(const BeamPicture& layout, const ImVec2& corner, const ImVec2& room) {
  const float cols = std::max<float>(1.0F, static_cast<float>(layout.cols));
  const float rows = std::max<float>(1.0F, static_cast<float>(layout.rows));
  constexpr float kWidest = 2.5F;  // width / height
  const bool is_grid = layout.kind == BeamPicture::Kind::grid;
  const float shape = is_grid ? std::clamp(cols / rows, 0.5F, kWidest) : cols / rows;
  const float width = std::max(1.0F, std::min(room.x, room.y * shape));
  const float height = width / shape;
  return {corner.x + 0.5F * (room.x - width), corner.y + 0.5F * (room.y - height), width, height};
}

/// A pixel that shows the beam; empty: none.
std::optional<std::size_t> pixel_of(const BeamPicture& layout, std::size_t beam) {
  if (layout.beams.empty()) return beam - layout.first;
  const auto found = std::find(layout.beams.begin(), layout.beams.end(), beam);
  if (found == layout.beams.end()) return std::nullopt;
  return static_cast<std::size_t>(found - layout.beams.begin());
}

ImTextureID texture_id(GLuint name) {
  // NOLINTNEXTLINE(performance-no-int-to-ptr): Dear ImGui takes a number of OpenGL as a pointer
  return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(name));
}

}  // namespace

void Screen::upload(const Viewer& viewer) {
  if (uploaded_ == viewer.version() || viewer.snapshot() == nullptr) return;
  uploaded_ = viewer.version();
  upload_picture(viewer.picture());
  upload_points(viewer);
  cloud_.set_lines(viewer.guides());
}

void Screen::upload_picture(const SensorPicture& picture) {
  constexpr std::size_t kMax = 4096;  // pixels; every device supports such textures
  const BeamPicture& layout = picture.layout;
  const std::size_t step_x = std::max<std::size_t>(1, (layout.cols + kMax - 1) / kMax);
  const std::size_t step_y = std::max<std::size_t>(1, (layout.rows + kMax - 1) / kMax);
  std::vector<Colour> thinned;
  for (std::size_t row = 0; row < layout.rows; row += step_y) {
    for (std::size_t col = 0; col < layout.cols; col += step_x) {
      const std::uint32_t beam = layout.beam_at(row * layout.cols + col);
      thinned.push_back(beam == BeamPicture::kNoBeam ? kPlotGround : picture.colours[beam]);
    }
  }
  const auto width = static_cast<GLsizei>((layout.cols + step_x - 1) / step_x);
  const auto height = static_cast<GLsizei>((layout.rows + step_y - 1) / step_y);
  glBindTexture(GL_TEXTURE_2D, sensor_.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, width, height, 0, GL_RGB, GL_UNSIGNED_BYTE,
               thinned.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

void Screen::upload_points(const Viewer& viewer) {
  constexpr std::size_t kMax = 2'000'000;  // software rendering stays interactive
  const std::vector<Eigen::Vector3f>& all = viewer.points();
  shown_one_of_ = std::max<std::size_t>(1, (viewer.summary().hits + kMax - 1) / kMax);
  std::vector<ColouredVertex> points;
  points.reserve(viewer.summary().hits / shown_one_of_ + 1);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (std::isnan(all[i].x()) || hits++ % shown_one_of_ != 0) continue;
    points.push_back({.position_m = all[i], .colour = viewer.picture().colours[i]});
  }
  cloud_.set_points(points);
}

void Screen::draw_cloud(const Viewer& viewer, int width, int height) {
  const CloudView style{
      .width = width,
      .height = height,
      .clip_from_anchor = clip_from_anchor(viewer.style.orbit, static_cast<double>(width) / height),
      .point_size = viewer.style.point_size};
  const bool is_same = drawn_version_ == viewer.version() && style.width == drawn_.width &&
                       style.height == drawn_.height && style.point_size == drawn_.point_size &&
                       style.clip_from_anchor == drawn_.clip_from_anchor;
  if (is_same) return;
  cloud_.draw(style);
  drawn_ = style;
  drawn_version_ = viewer.version();
}

void Screen::show_sensor_view(Viewer& viewer) {
  if (viewer.snapshot() == nullptr) return;
  const BeamPicture& layout = viewer.picture().layout;
  ImVec2 room = ImGui::GetContentRegionAvail();
  room.y = std::max(1.0F, room.y - 2.0F * ImGui::GetTextLineHeightWithSpacing());
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const Area area = fit_picture(layout, corner, room);
  const ImVec2 first(area.x, area.y);
  const ImVec2 last(area.x + area.width, area.y + area.height);
  ImGui::SetCursorScreenPos(first);
  ImGui::InvisibleButton("sensor", ImVec2(area.width, area.height));
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddImage(texture_id(sensor_.name()), first, last);
  use_mouse_on_sensor(viewer);
  if (const auto pixel = viewer.picked() ? pixel_of(layout, *viewer.picked()) : std::nullopt) {
    const auto col = static_cast<float>(*pixel % layout.cols);
    const std::size_t whole_row = *pixel / layout.cols;
    const auto row = static_cast<float>(whole_row);
    const float x = area.x + (col + 0.5F) * area.width / static_cast<float>(layout.cols);
    const float y = area.y + (row + 0.5F) * area.height / static_cast<float>(layout.rows);
    draw.AddCircle(ImVec2(x, y), 7.0F, kMarkColour, 0, 2.0F);
  }
  if (viewer.selection_visibility() == Visibility::outside) {
    const std::string hint = viewer.selected_name() + " is outside this image: press f to frame it";
    draw.AddText(ImVec2(area.x + 6.0F, area.y + 4.0F), kMarkColour, hint.c_str());
  }
  ImGui::SetCursorScreenPos(ImVec2(corner.x, corner.y + room.y));
  show_legend(viewer);
}

void Screen::use_mouse_on_sensor(Viewer& viewer) {
  const Eigen::Vector2d drag = dragged(ImGuiMouseButton_Left);
  if (drag != Eigen::Vector2d::Zero()) viewer.rotate_objects(drag);
  if (ImGui::IsItemHovered() && ImGui::GetIO().MouseWheel != 0.0F) {
    viewer.step_sensor(ImGui::GetIO().MouseWheel);
  }
  if (!is_clicked()) return;
  const BeamPicture& layout = viewer.picture().layout;
  const ImVec2 first = ImGui::GetItemRectMin();
  const ImVec2 size = ImGui::GetItemRectSize();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const double col = std::floor((mouse.x - first.x) / size.x * static_cast<float>(layout.cols));
  const double row = std::floor((mouse.y - first.y) / size.y * static_cast<float>(layout.rows));
  if (col < 0.0 || row < 0.0 || col >= layout.cols || row >= layout.rows) return;
  const std::uint32_t beam =
      layout.beam_at(static_cast<std::size_t>(row) * layout.cols + static_cast<std::size_t>(col));
  if (beam != BeamPicture::kNoBeam) viewer.pick(beam);
}

void Screen::show_cloud_view(Viewer& viewer) {
  if (viewer.snapshot() == nullptr) return;
  ImVec2 room = ImGui::GetContentRegionAvail();
  room.x = std::max(1.0F, room.x);
  room.y = std::max(1.0F, room.y - 2.0F * ImGui::GetTextLineHeightWithSpacing());
  const ImVec2 first = ImGui::GetCursorScreenPos();
  const ImVec2 last(first.x + room.x, first.y + room.y);
  ImGui::InvisibleButton("cloud", room,
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  viewer.style.aspect = static_cast<double>(room.x) / static_cast<double>(room.y);
  use_mouse_on_cloud(viewer);
  draw_cloud(viewer, static_cast<int>(room.x), static_cast<int>(room.y));
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddImage(texture_id(cloud_.texture()), first, last, ImVec2(0.0F, 1.0F), ImVec2(1.0F, 0.0F));
  const bool is_marked = viewer.picked() && !std::isnan(viewer.points()[*viewer.picked()].x());
  if (is_marked) {
    const Eigen::Vector3f at = viewer.points()[*viewer.picked()];
    const Eigen::Vector4f clip =
        clip_from_anchor(viewer.style.orbit, static_cast<double>(room.x) / room.y) *
        at.homogeneous();
    const ImVec2 place(first.x + 0.5F * room.x * (1.0F + clip.x() / clip.w()),
                       first.y + 0.5F * room.y * (1.0F - clip.y() / clip.w()));
    if (clip.w() > 0.0F) draw.AddCircle(place, 7.0F, kMarkColour, 0, 2.0F);
  }
  ImGui::Text("grid %g m; axes x red, y green, z blue", viewer.style.grid_m);
  if (shown_one_of_ > 1) ImGui::Text("1 of %zu points is drawn", shown_one_of_);
}

void Screen::use_mouse_on_cloud(Viewer& viewer) {
  Orbit& orbit = viewer.style.orbit;
  const double distance_before_m = orbit.distance_m;
  turn(orbit, dragged(ImGuiMouseButton_Left));
  pan(orbit, dragged(ImGuiMouseButton_Right) + dragged(ImGuiMouseButton_Middle));
  if (ImGui::IsItemHovered()) zoom(orbit, static_cast<double>(ImGui::GetIO().MouseWheel));
  if (orbit.distance_m != distance_before_m) viewer.update_view();  // the grid changes
  if (!is_clicked()) return;
  constexpr double kReach = 0.01;  // heights
  const ImVec2 first = ImGui::GetItemRectMin();
  const ImVec2 size = ImGui::GetItemRectSize();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const Eigen::Vector2d place((2.0 * (mouse.x - first.x) - size.x) / size.y,
                              (size.y - 2.0 * (mouse.y - first.y)) / size.y);
  const auto point = point_at(orbit, viewer.points(), place, kReach);
  if (point) viewer.pick(point);
}

void Screen::show(Viewer& viewer, const WindowSize& size, const FrameRate& rate) {
  upload(viewer);
  const auto width = static_cast<float>(size.width);
  const auto height = static_cast<float>(size.height);
  const float line = 2.0F * ImGui::GetFrameHeightWithSpacing();
  const float controls = std::min(23.0F * ImGui::GetFontSize(), 0.5F * width);
  const float errors = viewer.errors.empty() ? 0.0F : std::min(0.25F * height, 4.0F * line);
  const float trace = viewer.trace.empty() ? 0.0F : 0.4F * height;
  const float views = std::max(1.0F, height - line - errors - trace);
  const float half = std::max(1.0F, 0.5F * (width - controls));
  {
    const Panel panel("GLIDAR", {0.0F, 0.0F, controls, height - line});
    show_controls(viewer);
  }
  {
    const Panel panel("What the sensor sees", {controls, errors, half, views});
    show_sensor_view(viewer);
  }
  {
    const Panel panel("Point cloud", {controls + half, errors, half, views});
    show_cloud_view(viewer);
  }
  if (errors > 0.0F) {
    ImGui::PushStyleColor(ImGuiCol_WindowBg, IM_COL32(110, 25, 25, 255));
    const Panel panel("Errors", {controls, 0.0F, width - controls, errors});
    ImGui::PopStyleColor();
    show_errors(viewer);
  }
  if (trace > 0.0F) {
    const Panel panel("Point trace", {controls, errors + views, width - controls, trace});
    show_trace(viewer);
  }
  const Panel panel("status", {0.0F, height - line, width, line},
                    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoScrollbar);
  show_status(viewer, rate);
}

}  // namespace glidar::app
