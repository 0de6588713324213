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

/// One step of a sensor's noise. A sensor has an ordered list of steps; step k, from 0, uses random
/// numbers of the purpose first_noise_step + k, so that steps share none.
using NoiseStep = std::variant<RangeGaussian, RangeSnr, RangeCrlb, RangeShotNoise, RangeUniform,
                               RangeQuantization, RangeBias, RangeDrift, Dropout, Crosstalk,
                               FalseAlarms, DisparityQuantization, KinectV1, Khoshelham,
                               NguyenAxial, NguyenLateral, IclKinect, Stereo, ContinuousWave,
                               IntensityGaussian, IntensityScale, PointingJitter, EncoderError>;

/// Maximum number of steps in a list, because purposes have 8 bits.
inline constexpr std::size_t kMaxNoiseSteps = 224;

/// The purpose of the random numbers of step k.
Purpose rng_purpose(std::size_t step);

/// Adds the ground truth columns that the steps read to `fields`.
void add_required_fields(const std::vector<NoiseStep>& noise, HitFieldMask& fields);

/// The beams as fired: `beams` itself if no step has pointing noise, else a copy in the frame's
/// workspace with the pointing noise of this frame, given by its seed, sensor_id and number.
const Beams& perturbed_beams(const std::vector<NoiseStep>& noise, const Beams& beams,
                             ThreadPool& thread_pool, Frame& frame);

/// Applies all other steps in order to a measured frame; frame_s is the frame period in seconds.
/// `beams` are the nominal beams, without pointing noise. The result does not depend on the number
/// of threads. Returns whose final range is not positive get the status too_near.
void apply_noise(const std::vector<NoiseStep>& noise, double frame_s, const Beams& beams,
                 ThreadPool& thread_pool, Frame& frame);

/// Applies only the first `count` steps of the list.
void apply_noise_prefix(const std::vector<NoiseStep>& noise, std::size_t count, double frame_s,
                        const Beams& beams, ThreadPool& thread_pool, Frame& frame);

}  // namespace glidar
