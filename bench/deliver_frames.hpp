// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "model_view.hpp"

#include <apps/glidar/run/delivery.hpp>

#include <benchmark/benchmark.h>

#include <cstdint>
#include <memory>

namespace glidar::bench {

/// Measures a frame per iteration and submits it, as `glidar stream --rate max` does.
inline void deliver_frames(benchmark::State& state, const ModelView& view,
                           const std::shared_ptr<const Beams>& beams, app::Delivery& delivery) {
  std::uint32_t number = 0;
  for (auto _ : state) {
    app::MeasuredFrame& slot = delivery.next_slot();
    slot.beams = beams;
    slot.frame.number = number++;
    view.measure(slot.frame);
    delivery.submit();
  }
  delivery.finish();
}

}  // namespace glidar::bench
