// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth/temporal.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <type_traits>

namespace glidar::depth {
namespace {

constexpr unsigned kCycle = 8;

/// A hole keeps its last value when at least `valid` of the last `frames` frames had one.
struct Persistence {
  int valid;
  unsigned frames;
};
constexpr std::array<Persistence, 9> kPersistence = {
    {{9, 8}, {8, 8}, {2, 3}, {2, 4}, {2, 8}, {1, 2}, {1, 5}, {1, 8}, {0, 8}}};

/// `history` at the bit `frame` is about the frame 8 before this one.
bool persists(const Persistence& rule, std::uint8_t history, unsigned frame) {
  const std::uint8_t newest_first = std::rotl(history, static_cast<int>(kCycle - frame));
  const auto recent = static_cast<std::uint8_t>(newest_first >> (kCycle - rule.frames));
  return std::popcount(recent) >= rule.valid;
}

struct Averaging {
  float alpha;
  float rest;  ///< 1 - alpha
  float delta;
  Persistence persistence;
  unsigned frame;
};

/// The value of one pixel; updates what is kept of it. Depths are rounded down.
template <class Value>
Value average_pixel(const Averaging& rule, Value value, float& last, std::uint8_t& history) {
  const auto bit = static_cast<std::uint8_t>(1U << rule.frame);
  const auto now = static_cast<float>(value);
  if (value == Value{}) {
    const bool is_kept = last != 0.0F && persists(rule.persistence, history, rule.frame);
    history = static_cast<std::uint8_t>(history & ~bit);
    return is_kept ? static_cast<Value>(last) : value;
  }
  if (last == 0.0F || !(std::fabs(now - last) < rule.delta)) {
    last = now;
    history = bit;
    return value;
  }
  history = static_cast<std::uint8_t>(history | bit);
  const auto mixed = static_cast<Value>(rule.alpha * now + rule.rest * last);
  last = static_cast<float>(mixed);
  return mixed;
}

}  // namespace

void apply(const TemporalFilter& filter, FilterImage& image, TemporalState& state) {
  const std::size_t pixels = image.width * image.height;
  if (state.last.size() != pixels)
    state = {std::vector<float>(pixels), std::vector<std::uint8_t>(pixels), 0};
  const auto alpha = static_cast<float>(filter.alpha);
  const Averaging rule = {alpha, 1.0F - alpha, static_cast<float>(filter.delta),
                          kPersistence[filter.persistence], state.frame};
  std::visit(
      [&](auto& values) {
        for (std::size_t i = 0; i < pixels; ++i) {
          values[i] = average_pixel(rule, values[i], state.last[i], state.history[i]);
        }
      },
      image.values);
  state.frame = (state.frame + 1) % kCycle;
}

}  // namespace glidar::depth
