// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/opengl/context.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glidar::opengl {

/// Descriptions of the graphics devices that EGL lists: hardware first, software last.
std::vector<std::string> graphics_devices();

/// An OpenGL 3.3 core context without window or display.
class EglContext final : public Context {
 public:
  /// On the device of this index among graphics_devices(); empty: on the first with a context.
  /// Throws Error that states what to install when there is none.
  explicit EglContext(std::optional<std::uint32_t> device);
  ~EglContext() override;

  void make_current() override;
  void release() override;

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace glidar::opengl
