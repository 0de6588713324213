// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace glidar::opengl {

/// A context of OpenGL 3.3 or later: one without a window (EglContext), or that of a window. What
/// draws needs it to be current and does not care whose it is.
class Context {
 public:
  Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  virtual ~Context() = default;

  /// Makes it current in this thread, or throws Error. Asked for by one thread at a time, and not
  /// again before release().
  virtual void make_current() = 0;

  /// Makes current again what was so before make_current(), in the same thread.
  virtual void release() = 0;
};

/// A context is current in this thread while this lives.
class ScopedContext {
 public:
  explicit ScopedContext(Context& context) : context_(context) { context_.make_current(); }
  ~ScopedContext() { context_.release(); }
  ScopedContext(const ScopedContext&) = delete;
  ScopedContext& operator=(const ScopedContext&) = delete;

 private:
  Context& context_;
};

}  // namespace glidar::opengl
