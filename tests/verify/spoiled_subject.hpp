// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/constants.hpp>
#include <glidar/verify/cases.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace glidar::testing {

/// A renderer that corrupts the hits of another one.
class Spoiled final : public Renderer {
 public:
  using Spoil = std::function<void(const CastRequest&, Hits&)>;
  Spoiled(std::unique_ptr<Renderer> inner, Spoil spoil)
      : inner_(std::move(inner)), spoil_(std::move(spoil)) {}

  [[nodiscard]] std::string_view name() const override { return inner_->name(); }
  [[nodiscard]] ThreadPool& thread_pool() override { return inner_->thread_pool(); }
  void cast(const CastRequest& request, Hits& hits) override {
    inner_->cast(request, hits);
    spoil_(request, hits);
  }

 private:
  std::unique_ptr<Renderer> inner_;
  Spoil spoil_;
};

/// A renderer whose hits are spoiled, by the request for them if that matters.
inline VerifySubject spoiled_subject(const std::string& kind, const Spoiled::Spoil& spoil) {
  VerifySubject subject;
  subject.renderer = kind;
  subject.casts = beams_of_renderer(kind);
  subject.make = [=](const Scene& scene) -> std::unique_ptr<Renderer> {
    return std::make_unique<Spoiled>(make_renderer(scene, {.kind = kind, .threads = 2}), spoil);
  };
  return subject;
}

inline VerifySubject subject(
    const std::string& kind, const std::function<void(Hits&)>& spoil = [](Hits&) {}) {
  return spoiled_subject(kind, [=](const CastRequest&, Hits& hits) { spoil(hits); });
}

/// Adds 0.002 steps of float32 to every range.
inline void shift_ranges(Hits& hits) {
  for (double& range_m : hits.range_m) {
    if (!std::isfinite(range_m)) continue;
    const auto single = static_cast<float>(range_m);
    range_m += 0.002 * (std::nextafter(single, std::numeric_limits<float>::infinity()) - single);
  }
}

inline void swap_triangles(Hits& hits) {
  for (std::uint32_t& primitive : hits.primitive) {
    if (primitive != kInvalidId) primitive ^= 1U;
  }
}

inline void swap_instances(Hits& hits) {
  for (std::uint32_t& instance : hits.instance) {
    if (instance != kInvalidId) instance = instance == 0 ? 1 : 0;
  }
}

inline void lose_one_hit(Hits& hits) {
  const auto hit = std::find_if(hits.instance.begin(), hits.instance.end(),
                                [](std::uint32_t i) { return i != kInvalidId; });
  if (hit == hits.instance.end()) return;
  hits.range_m[static_cast<std::size_t>(hit - hits.instance.begin())] = kNaN;
  *hit = kInvalidId;
}

inline void lose_every_hit(Hits& hits) {
  std::fill(hits.instance.begin(), hits.instance.end(), kInvalidId);
  std::fill(hits.range_m.begin(), hits.range_m.end(), kNaN);
}

class SpecialCases : public ::testing::Test {
 protected:
  /// The first case of a name.
  const SpecialCase& named(const std::string& name) {
    return *std::find_if(cases_.begin(), cases_.end(),
                         [&](const SpecialCase& c) { return c.name == name; });
  }
  [[nodiscard]] const std::vector<SpecialCase>& all() const { return cases_; }
  [[nodiscard]] const std::vector<Shape>& shapes() const { return shapes_; }

 private:
  std::vector<Shape> shapes_ = make_shapes();
  std::vector<SpecialCase> cases_ = special_cases(shapes_);
};

}  // namespace glidar::testing
