// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/wayland_display.hpp>

#include <glidar/core/text.hpp>
#include <glidar/io/files/unique_fd.hpp>

#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string_view>

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
constexpr std::uint32_t kDone = 3;

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
    globals.is_complete = word_at(bytes, at) == kDone;
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
  const std::array<std::uint32_t, 6> requests = {kDisplay, kSize | 1U, kRegistry,  // get_registry
                                                 kDisplay, kSize,      kDone};     // sync
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

}  // namespace

std::string variable(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::string variable_text(const char* name) {
  const std::string value = variable(name);
  return std::string(name) + (value.empty() ? " is not set" : " is '" + excerpt(value) + "'");
}

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

}  // namespace glidar::app
