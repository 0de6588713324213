// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/tof_measurement.hpp>

#include <glidar/simulate/tof_light.hpp>
#include <glidar/tof/tof_decode.hpp>

namespace glidar {
namespace {

constexpr std::size_t kTofPixelsPerTask = 1024;

/// Raw values of a pixel.
void expose_pixel(const Simulation& s, const PreparedTof& prepared, std::size_t pixel,
                  TofImages& images) {
  const std::size_t steps = step_count(prepared);
  RngKey key = rng_key(s.frame, Purpose::tof_exposure, pixel);
  for (std::size_t step = 0; step < steps; ++step) {
    key.block = static_cast<std::uint32_t>(step);
    images.level[step * s.beams.size() + pixel] = expose(
        prepared.camera, step / images.taps, s.workspace.tof.light[pixel * steps + step], key);
  }
}

/// Raw values of all pixels and phase steps.
void expose_images(const Simulation& s, const PreparedTof& prepared, TofImages& images) {
  const std::size_t pixels = s.beams.size();
  const std::size_t steps = step_count(prepared);
  images.width = s.beams.cols;
  images.height = s.beams.rows;
  images.frequencies = static_cast<std::uint32_t>(prepared.steps.frequencies);
  images.taps = static_cast<std::uint32_t>(prepared.steps.taps);
  images.level.resize(pixels * steps);
  const auto expose_pixels = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) expose_pixel(s, prepared, i, images);
  };
  s.renderer.thread_pool().parallel_for(pixels, kTofPixelsPerTask, expose_pixels);
}

Status status_of(TofStatus status, bool is_miss) {
  switch (status) {
    case TofStatus::valid:
      return Status::hit;
    case TofStatus::not_illuminated:
      return Status::invalid_pixel;
    case TofStatus::saturated:
      return Status::saturated;
    case TofStatus::low_signal:
      return is_miss ? Status::miss : Status::below_threshold;
    case TofStatus::ambiguous:
      return is_miss ? Status::miss : Status::phase_ambiguous;
    case TofStatus::too_near:
      return Status::too_near;
    case TofStatus::too_far:
      return Status::too_far;
    case TofStatus::edge:
      return Status::filtered_edge;
  }
  return Status::phase_ambiguous;
}

/// Share of the light of the illuminator that came over bounces.
float bounced_share(const Simulation& s, std::size_t steps, std::size_t pixel) {
  const double signal = s.workspace.tof.light[pixel * steps].signal;
  const double bounced = s.workspace.tof.bounced[pixel];
  return signal > 0.0 ? static_cast<float>(bounced / signal) : 0.0F;
}

/// The mean of the amplitudes of all frequencies.
float mean_amplitude(const TofMeasurement& measured, std::size_t pixels, std::size_t pixel) {
  double sum = 0.0;
  for (std::size_t f = 0; f < measured.frequencies; ++f)
    sum += double{measured.amplitude[f * pixels + pixel]};
  return static_cast<float>(sum / measured.frequencies);
}

/// The return of a pixel.
void set_return(const Simulation& s, const PreparedTof& prepared, const TofMeasurement& measured,
                std::size_t i) {
  Frame& frame = s.frame;
  frame.tof_amplitude[i] = mean_amplitude(measured, s.beams.size(), i);
  frame.bounced_share[i] = bounced_share(s, step_count(prepared), i);
  const bool is_miss = frame.ground_truth.instance[i] == kInvalidId;
  const Status status = status_of(measured.status[i], is_miss);
  if (status != Status::hit) return invalidate_return(frame, i, status);
  frame.status[i] = Status::hit;
  frame.return_source[i] = is_miss ? ReturnSource::false_alarm : ReturnSource::surface;
  frame.range_m[i] = measured.range_m[i];
  frame.intensity[i] = frame.tof_amplitude[i];
}

void set_returns(const Simulation& s, const PreparedTof& prepared, const TofMeasurement& measured) {
  Frame& frame = s.frame;
  const std::size_t pixels = s.beams.size();
  frame.tof_amplitude.resize(pixels);
  frame.bounced_share.resize(pixels);
  frame.return_source.assign(pixels, ReturnSource::none);
  const auto set = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) set_return(s, prepared, measured, i);
  };
  s.renderer.thread_pool().parallel_for(pixels, kTofPixelsPerTask, set);
}

TofCalibration calibration_of(const PreparedTof& prepared) {
  return {.depth_per_range = prepared.depth_per_range, .is_illuminated = prepared.is_illuminated};
}

}  // namespace

void measure(const Simulation& s, const PreparedTof& prepared) {
  find_tof_light(s, prepared);
  expose_images(s, prepared, s.frame.tof_images);
  set_returns(s, prepared,
              decode_tof(s.frame.tof_images, prepared.decoder, calibration_of(prepared),
                         {.pool = &s.renderer.thread_pool()}));
}

TofPixelTrace trace_pixel(const Simulation& s, const PreparedTof& prepared, std::size_t pixel) {
  const std::size_t steps = step_count(prepared);
  const auto first = s.workspace.tof.light.begin() + static_cast<std::ptrdiff_t>(pixel * steps);
  const auto row = static_cast<std::uint32_t>(pixel / s.beams.cols);
  const auto column = static_cast<std::uint32_t>(pixel % s.beams.cols);
  return {.light = {first, first + static_cast<std::ptrdiff_t>(steps)},
          .bounced_share = double{s.frame.bounced_share[pixel]},
          .decoded = explain_tof(s.frame.tof_images, prepared.decoder, {column, row},
                                 calibration_of(prepared), {.pool = &s.renderer.thread_pool()})};
}

}  // namespace glidar
