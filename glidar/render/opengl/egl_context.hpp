// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glidar::opengl {

/// The graphics devices that EGL tells of, each in words: hardware first, software last.
std::vector<std::string> graphics_devices();

/// An OpenGL 3.3 core context without window or display. What draws needs some current context and
/// does not care whose.
class EglContext {
 public:
  /// On the device of this index among graphics_devices(); empty: on the first that can. Throws
  /// Error that says what to install when there is none.
  explicit EglContext(std::optional<std::uint32_t> device);
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  /// Makes the context current in this thread while it lives; then what was current before is
  /// again. One thread at a time.
  class Use {
   public:
    explicit Use(const EglContext& context);
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    struct Before;
    std::unique_ptr<Before> before_;
  };

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace glidar::opengl
