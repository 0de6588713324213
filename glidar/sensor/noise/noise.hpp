// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/math/thread_pool.hpp>
#include <glidar/sensor/noise/depth_noise.hpp>
#include <glidar/sensor/noise/dropout.hpp>
#include <glidar/sensor/noise/intensity_noise.hpp>
#include <glidar/sensor/noise/noise_workspace.hpp>
#include <glidar/sensor/noise/pointing_noise.hpp>
#include <glidar/sensor/noise/range_bias.hpp>
#include <glidar/sensor/noise/range_noise.hpp>
#include <glidar/sensor/noise/tof_noise.hpp>

#include <variant>
#include <vector>

namespace glidar {

struct SampleRecorder;

// clang-format off
/// One step of a sensor's noise. A sensor has an ordered list of steps; step k, from 0, uses random
/// numbers of the purpose first_noise_step + k, so that steps share none.
using NoiseStep = std::variant<
    RangeGaussian,
    RangeSnr,
    RangeCrlb,
    RangeShotNoise,
    RangeUniform,
    RangeQuantization,
    RangeBias,
    RangeDrift,
    Dropout,
    Crosstalk,
    FalseAlarms,
    DisparityQuantization,
    KinectV1,
    Khoshelham,
    NguyenAxial,
    NguyenLateral,
    IclKinect,
    Stereo,
    ContinuousWave,
    IntensityGaussian,
    IntensityScale,
    PointingJitter,
    EncoderError>;
// clang-format on

/// Maximum number of steps in a list, because purposes have 8 bits.
inline constexpr std::size_t kMaxNoiseSteps = 224;

/// Keys in sensor files: `type` and those of the step.
void describe(NoiseStep& step, FieldVisitor& visitor);

/// The purpose of the random numbers of step k.
Purpose rng_purpose(std::size_t step);

/// Adds the ground truth columns that the steps read.
void add_required_hit_columns(const std::vector<NoiseStep>& noise, HitColumnMask& hit_columns);

/// Noise steps with what is the same for all frames, see plan_noise().
struct NoisePlan {
  /// Steps that are applied to a batch of beams before the next batch is loaded.
  struct Run {
    std::size_t begin = 0;  ///< index of the first step
    std::size_t end = 0;
    bool reads_neighbours = false;  ///< the first step does, the others do not
    bool reads_depth = false;
  };
  std::vector<NoiseStep> steps;
  double frame_s = 0.0;  ///< from one frame to the next
  std::vector<Run> runs = {};
  bool perturbs_directions = false;  ///< by pointing noise
  bool changes_returns = false;      ///< there are steps other than pointing noise
  bool reads_neighbours = false;
  bool adds_returns = false;
  SampleRecorder* recorder = nullptr;  ///< set by trace_samples()
};

/// Prepares the steps for a sensor that measures a frame every frame_s seconds.
NoisePlan plan_noise(std::vector<NoiseStep> steps, double frame_s);

/// The beams as fired: `beams` itself if no step has pointing noise, else `perturbed`, which
/// receives a copy with the pointing noise of this frame, given by its seed, sensor_id and number.
const Beams& perturb_directions(const NoisePlan& noise, const Beams& beams, const Frame& frame,
                                ThreadPool& thread_pool, Beams& perturbed);

/// Applies the other ones of the first `count` steps in order to a measured frame. `beams` are the
/// nominal beams, without pointing noise. The result does not depend on the number of threads.
/// Returns whose final range is not positive get the status too_near.
void apply_noise(const NoisePlan& noise, const Beams& beams, ThreadPool& thread_pool,
                 NoiseWorkspace& workspace, Frame& frame, std::size_t count = kMaxNoiseSteps);

}  // namespace glidar
