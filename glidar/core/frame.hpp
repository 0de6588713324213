// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/hits.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/math/random.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// Why a beam has a return, or has none.
enum class Status : std::uint8_t {
  hit = 0,
  miss = 1,                ///< nothing on the beam
  too_near = 2,            ///< the surface lies before the sensor's near limit
  too_far = 3,             ///< the surface lies beyond the sensor's far limit
  invalid_pixel = 4,       ///< the optics have no ray for this pixel
  below_threshold = 5,     ///< the echo is too weak to be told from noise
  dropped = 6,             ///< lost at random
  occluded = 7,            ///< the projector or the second camera does not see the surface
  phase_ambiguous = 8,     ///< the phase is not plausible: the distance is ambiguous
  saturated = 9,           ///< the echo is too strong to be timed
  weather = 10,            ///< rain, snow or fog took the return
  no_return_of_rank = 11,  ///< the beam has fewer echoes than the sensor could tell
};

/// What made a return.
enum class ReturnSource : std::uint8_t {
  none = 0,         ///< there is no return
  surface = 1,      ///< the surface that the truth names
  mixed_pixel = 2,  ///< surfaces apart from each other, in one echo
  ghost = 3,        ///< a surface seen in a mirror, which the truth names
  false_alarm = 4,  ///< noise alone
  fog = 5,
  rain = 6,
  snow = 7,
  crosstalk = 8,  ///< another channel's echo
};

/// The status in words, as files and pictures spell it.
std::string_view name(Status status);
std::string_view name(ReturnSource cause);

/// Memory that steps of a measurement reuse from frame to frame; nothing to read for others.
struct Workspace {
  Beams aimed;                   ///< the beams with their errors of pointing; no directions: none
  std::vector<double> before;    ///< N, ranges or depths as they were before a step
  std::vector<float> amplitude;  ///< N, intensities as they were before a step
  Beams moved;                   ///< the beams as a body of a moving scene sees them
  std::vector<Pose> start_from_sensor;         ///< N, the sensor at each beam's time, likewise
  Hits body_hits;                              ///< on one body
  std::vector<std::uint8_t> instance_enabled;  ///< per instance
  Beams sub_beams;                             ///< those that a run of beams is spread into
  Hits sub_hits;                               ///< theirs
  std::vector<double> sub_signals;             ///< what each of these sends back
  Beams mirrored;                              ///< those that go on from a mirror
  Hits mirrored_hits;                          ///< theirs
  std::vector<std::uint32_t> mirrored_from;    ///< per mirrored beam: its sub-beam
};

/// A measurement as one picture, the way of the 2016 paper: red is the intensity, green and blue
/// are the depth in 65536 steps between two planes.
struct Woods2016Framebuffer {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  double near_m = 0.0;             ///< n of equation (8), depth along the boresight
  double far_m = 0.0;              ///< f
  std::vector<std::uint8_t> rgba;  ///< 4 x rows x cols, row 0 on top; alpha 0 where nothing is seen
};

/// One measurement: what the sensor reports per beam, with the truth attached. N = rows * cols.
struct Frame {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::string frame_id;         ///< the sensor's frame
  std::int64_t stamp_ns = 0;    ///< start of the measurement
  std::uint64_t seed = 0;       ///< of all random numbers
  std::uint32_t sensor_id = 0;  ///< sensors of one rig draw different numbers
  std::uint32_t number = 0;     ///< of the frame in its sequence; frames draw different numbers
  Pose world_from_sensor = Pose::Identity();
  std::vector<Pose> world_from_instance;    ///< one per instance of the scene, at stamp_ns
  std::vector<double> range_m;              ///< N, measured; NaN unless status is hit
  std::vector<float> intensity;             ///< N, received signal of a full-scale 1; 0 unless hit
  std::vector<Status> status;               ///< N
  std::vector<ReturnSource> return_source;  ///< N; empty: `surface` wherever there is a return
  std::vector<float> sigma_m;  ///< N, standard deviation of the random error of range_m; empty: 0
  /// When the sensor moves during the frame: the beams as seen from its pose at stamp_ns. With them
  /// points lie where they were measured. Empty when it does not: as the sensor's own beams.
  struct Deskewed {
    std::vector<Eigen::Vector3d> directions;            ///< N, unit vectors
    std::vector<Eigen::Vector3d> true_directions;       ///< N, with errors of pointing; empty: same
    std::vector<Eigen::Vector3d> origins_m;             ///< N
    std::vector<Eigen::Quaternionf> start_from_sensor;  ///< N, rotation since stamp_ns
  };
  Deskewed deskewed;
  /// Where the sensor and the object that a beam hit were when it left. Empty unless asked for.
  struct BeamPoses {
    std::vector<PoseVector> world_from_sensor;  ///< N
    std::vector<PoseVector> world_from_object;  ///< N, without scale; NaN where nothing was hit
  };
  BeamPoses beam_poses;
  Woods2016Framebuffer picture;  ///< that range and intensity were read from; no bytes: from none
  Hits ground_truth;             ///< what is there, whether reported or not
  Workspace workspace;
};

/// Gives the measured columns `size` entries (contents unspecified).
void resize(Frame& frame, std::size_t size);

/// Takes an entry's return away.
void invalidate_return(Frame& frame, std::size_t entry, Status why);

/// The draw of a beam of the frame for a purpose.
RngKey rng_key(const Frame& frame, Purpose purpose, std::size_t beam);

/// A run of beams, for work shared out among threads.
struct BeamRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};

}  // namespace glidar
