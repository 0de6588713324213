// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

namespace glidar {

template <class Signature>
class FunctionRef;

/// Refers to something callable without owning it and without allocating. It must outlive the
/// reference.
template <class Result, class... Args>
class FunctionRef<Result(Args...)> {
 public:
  FunctionRef() = default;

  template <class Body>
  explicit FunctionRef(const Body& body)
      : body_(&body), call_([](const void* erased, Args... args) -> Result {
          return (*static_cast<const Body*>(erased))(std::forward<Args>(args)...);
        }) {}

  explicit operator bool() const { return call_ != nullptr; }
  Result operator()(Args... args) const { return call_(body_, std::forward<Args>(args)...); }

 private:
  const void* body_ = nullptr;
  Result (*call_)(const void*, Args...) = nullptr;
};

}  // namespace glidar
