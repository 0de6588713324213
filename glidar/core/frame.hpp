// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/hits.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/core/raw_images.hpp>
#include <glidar/math/random.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

struct Mesh;
struct Scene;

/// The oriented bounding box of an object at the start of a frame, and how much of the object the
/// sensor sees. "Beams" are those of the nominal optics, without pointing errors and widths, each
/// at its firing time and once however many returns it has; limits of range do not matter.
struct ObjectBox {
  std::uint32_t instance = 0;  ///< index into Scene::instances
  /// The box's centre and axes, which are those of the object, in the sensor frame at stamp_ns.
  Pose sensor_from_box = Pose::Identity();
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();  ///< along the box's x, y and z; tight
  /// Of the centre relative to the world at stamp_ns, in the axes of the sensor.
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  std::uint32_t points = 0;         ///< returns of the frame whose ground truth is this object
  std::uint32_t beams = 0;          ///< that would hit the object if it were alone
  std::uint32_t visible_beams = 0;  ///< of these, those that hit it first in the scene
};

/// The objects that get a box.
enum class BoxSelection : std::uint8_t { with_class, all };

/// The fraction of the beams that would hit the object if it were alone, but hit another one first:
/// 1 - visible_beams / beams. NaN where no beam would hit it.
double occlusion(const ObjectBox& box);

/// The box around the corners of all triangles, in the object frame and before scale; an empty box
/// for a mesh without triangles.
Eigen::AlignedBox3d surface_bounds(const Mesh& mesh);

/// True when an instance of the scene has a class.
bool has_classes(const Scene& scene);

/// Whether a beam has a return, and why not.
enum class Status : std::uint8_t {
  hit = 0,
  miss = 1,                ///< no surface on the beam
  too_near = 2,            ///< the surface is nearer than the sensor's near limit
  too_far = 3,             ///< the surface is farther than the sensor's far limit
  invalid_pixel = 4,       ///< the optics have no ray for this pixel
  below_threshold = 5,     ///< the echo is too weak to be detected
  dropped = 6,             ///< random dropout
  occluded = 7,            ///< the projector or the second camera does not see the surface
  phase_ambiguous = 8,     ///< the phases are inconsistent: the range is ambiguous
  saturated = 9,           ///< the echo is too strong to be timed
  weather = 10,            ///< attenuated below the threshold by rain, snow or fog
  no_return_of_rank = 11,  ///< the beam has fewer echoes than the sensor can report
  // Of depths from raw images:
  image_border = 12,         ///< the match is beyond the edge of the other image
  no_texture = 13,           ///< grey levels hardly change around the pixel
  outside_search = 14,       ///< the best match is the first or last disparity of the search
  ambiguous_match = 15,      ///< another disparity matches as well
  left_right_mismatch = 16,  ///< the other image selects another match
  projector_shadow = 17,     ///< another surface blocks the projector's light
  transparent = 18,          ///< the surface lets most of the light pass
  filtered_edge = 19,        ///< at an edge, where the light of two surfaces mixes
  low_modulation = 20,       ///< fringes hardly change: dark or far surface, strong other light
  weak_code = 21,            ///< bits of the Gray code are not certain
  inconsistent_code = 22,    ///< phase and Gray code contradict each other: edges, motion, noise
  outside_projector = 23,    ///< the projector's image does not reach the surface
};
inline constexpr std::size_t kStatusCount = 24;

/// The origin of a return.
enum class ReturnSource : std::uint8_t {
  none = 0,         ///< there is no return
  surface = 1,      ///< the surface of the ground truth
  mixed_pixel = 2,  ///< one echo of several surfaces with a gap between them
  ghost = 3,        ///< a surface seen in a mirror; the ground truth names the mirror
  false_alarm = 4,  ///< noise alone
  fog = 5,
  rain = 6,
  snow = 7,
  crosstalk = 8,  ///< another channel's echo
};

/// The name in words, as files and pictures spell it, e.g. "too near".
std::string_view name(Status status);
std::string_view name(ReturnSource source);

/// An image of the sensor from which its depths are decoded.
struct RawImage {
  std::string name;                   ///< "ir_left", "pattern_00" ...: see docs/files/images.md
  GreyImage grey = {};                ///< as the imager reports it
  std::vector<float> electrons = {};  ///< one per pixel: the mean without noise and speckle
};

/// A measurement as one RGBA image, by the method of the 2016 paper (Woods and Christian, J.
/// Imaging 2016, 2(1), 5): red is the intensity, green and blue are the depth in 65536 steps
/// between two planes.
struct Woods2016Framebuffer {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  double near_m = 0.0;             ///< n of equation (8), depth along the boresight
  double far_m = 0.0;              ///< f of equation (8)
  std::vector<std::uint8_t> rgba;  ///< 4 x rows x cols, row 0 on top; alpha 0: no surface visible
};

/// One measurement: what the sensor reports per beam, with the ground truth. N = rows * cols,
/// row-major, as in Beams. range_m is without Beams::range_offset_m, a cloud's `range` with it.
struct Frame {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::string frame_id;         ///< name of the sensor frame
  std::int64_t stamp_ns = 0;    ///< start of the measurement
  std::uint64_t seed = 0;       ///< seed of all random numbers
  std::uint32_t sensor_id = 0;  ///< sensors of one rig have different random numbers
  std::uint32_t number = 0;     ///< number in its sequence; frames have different random numbers
  Pose world_from_sensor = Pose::Identity();
  std::vector<Pose> world_from_instance;    ///< one per instance of the scene, at stamp_ns
  std::vector<double> range_m;              ///< N, measured; NaN unless status is hit
  std::vector<float> intensity;             ///< N, signal in units of the sensor; 0 unless hit
  std::vector<Status> status;               ///< N
  std::vector<ReturnSource> return_source;  ///< N; empty: `surface` wherever there is a return
  std::vector<float> sigma_m;  ///< N, standard deviation of the random error of range_m; empty: 0
  /// N, measured rate at which the range grows: positive for what moves away; NaN unless status is
  /// hit. Empty: the sensor does not measure it (Sensor::doppler).
  std::vector<double> radial_velocity_m_s;
  /// N, ground truth of it, with or without a return; NaN for a miss. Empty unless requested
  /// (HitColumnMask::radial_velocity) or measured.
  std::vector<double> true_radial_velocity_m_s;
  /// N, unit vectors in the sensor's frame: the directions of the beams as fired, with pointing
  /// noise. Empty: those of the nominal beams.
  std::vector<Eigen::Vector3d> true_directions;
  /// The beams in the sensor frame at stamp_ns, for a sensor that moves during the frame. Points
  /// computed with them are where they were measured. Empty if the sensor does not move.
  struct Deskewed {
    std::vector<Eigen::Vector3d> directions;            ///< N, unit vectors
    std::vector<Eigen::Vector3d> true_directions;       ///< N, with pointing noise; empty: same
    std::vector<Eigen::Vector3d> origins_m;             ///< N
    std::vector<Eigen::Quaternionf> start_from_sensor;  ///< N, rotation since stamp_ns
  };
  Deskewed deskewed;
  /// Poses of the sensor and of the object hit at each beam's firing time. Empty unless requested
  /// (HitColumnMask::poses).
  struct BeamPoses {
    std::vector<PoseVector> world_from_sensor;  ///< N
    std::vector<PoseVector> world_from_object;  ///< N, without scale; NaN for a miss
  };
  BeamPoses beam_poses;
  Woods2016Framebuffer framebuffer;  ///< range and intensity were decoded from it; empty: not used
  /// From which the ranges were decoded (DepthModel::physical); empty: none.
  std::vector<RawImage> raw_images;
  /// N, of stereo cameras: as matched, NaN where there is no match; empty: not matched.
  std::vector<float> disparity_px;
  /// N, of structured-light cameras: column (or row) of the projector, whole numbers are centres of
  /// pixels; NaN where it is not decoded. Empty: not decoded.
  std::vector<float> projector_px;
  TofImages tof_images;              ///< of time-of-flight cameras, as raw_images; empty: none
  std::vector<float> tof_amplitude;  ///< N, mean of the frequencies, in levels; empty: none
  std::vector<float>
      bounced_share;  ///< N, ground truth: share of the illuminator's light over bounces
  Hits ground_truth;  ///< the surfaces, whether reported or not
  /// Of the objects that have a class, in the order of the scene's instances. Empty unless
  /// requested (HitColumnMask::boxes).
  std::vector<ObjectBox> boxes;
};

/// Resizes the measured columns to `size` entries (contents unspecified).
void resize(Frame& frame, std::size_t size);

/// Removes the return of an entry: range and radial velocity NaN, intensity and sigma 0, status
/// `why`, source none.
void invalidate_return(Frame& frame, std::size_t entry, Status why);

/// The key of the random numbers of a beam of the frame.
RngKey rng_key(const Frame& frame, Purpose purpose, std::size_t beam);

/// The beams [begin, end).
struct BeamRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};

}  // namespace glidar
