// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace glidar::opengl {

/// A context of OpenGL 3.3 or later: without a window (EglContext), or that of a window. Drawing
/// code needs it to be current and does not depend on its type.
class Context {
 public:
  Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  virtual ~Context() = default;

  /// Makes it current in this thread, or throws Error. Called by one thread at a time, and not
  /// again before release().
  virtual void make_current() = 0;

  /// Restores the context that was current before make_current(), in the same thread.
  virtual void release() = 0;
};

/// Makes a context current in this thread for the lifetime of this object.
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
