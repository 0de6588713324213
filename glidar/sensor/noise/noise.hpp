// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/math/thread_pool.hpp>
#include <glidar/sensor/noise/depth_noise.hpp>
#include <glidar/sensor/noise/dropout.hpp>
#include <glidar/sensor/noise/intensity_noise.hpp>
#include <glidar/sensor/noise/pointing_noise.hpp>
#include <glidar/sensor/noise/range_bias.hpp>
#include <glidar/sensor/noise/range_noise.hpp>
#include <glidar/sensor/noise/tof_noise.hpp>

#include <variant>
#include <vector>

namespace glidar {

/// One imperfection of a sensor. A sensor has an ordered list of them; step k of the list draws its
/// random numbers with the purpose first_noise_step + k, so that steps do not share any.
using NoiseStep = std::variant<RangeGaussian, RangeSnr, RangeCrlb, RangeShotNoise, RangeUniform,
                               RangeQuantization, RangeBias, RangeDrift, Dropout, Crosstalk,
                               FalseAlarms, DisparityQuantization, KinectV1, Khoshelham,
                               NguyenAxial, NguyenLateral, IclKinect, Stereo, ContinuousWave,
                               IntensityGaussian, IntensityScale, PointingJitter, EncoderError>;

/// The most steps that a list may have: purposes are numbers of 8 bits.
inline constexpr std::size_t kMaxNoiseSteps = 224;

/// What step k of a list draws for.
Purpose rng_purpose(std::size_t step);

/// Adds to `fields` the truth that the steps look at.
void add_required_fields(const std::vector<NoiseStep>& noise, HitFieldMask& fields);

/// The beams as they really go: `beams` itself when no step turns them, else a copy in the frame's
/// scratch with the errors of this frame. The frame tells seed, sensor_id and number.
const Beams& perturbed_beams(const std::vector<NoiseStep>& noise, const Beams& beams,
                             ThreadPool& thread_pool, Frame& frame);

/// Applies all other steps in their order to a measured frame, of which one starts every frame_s
/// seconds. `beams` are those that the sensor reports. The result does not depend on the number of
/// threads. A return whose range is not above 0 in the end becomes too_near.
void apply_noise(const std::vector<NoiseStep>& noise, double frame_s, const Beams& beams,
                 ThreadPool& thread_pool, Frame& frame);

/// What a frame is like after the first `count` of the steps.
void apply_noise_prefix(const std::vector<NoiseStep>& noise, std::size_t count, double frame_s,
                        const Beams& beams, ThreadPool& thread_pool, Frame& frame);

}  // namespace glidar
