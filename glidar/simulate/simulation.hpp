// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/box_classes.hpp>
#include <glidar/depth_camera/stereo.hpp>
#include <glidar/sensor/lidar/plane_echo.hpp>
#include <glidar/simulate/direction_grid.hpp>
#include <glidar/simulate/moving_cast.hpp>
#include <glidar/simulate/prepared_sensor.hpp>
#include <glidar/simulate/return_replacement.hpp>
#include <glidar/simulate/waveform_trace.hpp>

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace glidar {

/// How the footprint of a pulse is measured, see FlatFootprints.
struct FlatFootprint {
  enum class Kind : std::uint8_t {
    unknown,
    nothing,   ///< all sub-rays miss
    sampled,   ///< by sub-rays
    plain,     ///< in closed form
    coloured,  ///< in closed form, with reflectances at the sub-rays
  };
  Kind kind = Kind::unknown;
  PlaneMoments moments = {};  ///< of closed forms

  [[nodiscard]] bool is_in_closed_form() const {
    return kind == Kind::plain || kind == Kind::coloured;
  }
};

/// Beams that are cast beside those of the sensor: sub-rays of pulses, beams from a projector.
struct SubRayWorkspace {
  std::size_t first_pulse = 0;  ///< whose sub-rays come first
  Beams beams;
  Hits hits;                                 ///< of `beams`
  std::vector<std::uint8_t> hidden;          ///< per beam of the sensor, see find_hidden()
  std::vector<FlatFootprint> flat;           ///< per pulse, as far as it is known
  std::vector<double> signals;               ///< per sub-ray: its signal alone
  std::vector<double> velocities_m_s;        ///< per sub-ray: radial velocity; empty: not wanted
  Beams mirrored;                            ///< beams reflected by mirrors
  Hits mirrored_hits;                        ///< of `mirrored`
  std::vector<std::uint32_t> mirrored_from;  ///< per mirrored beam: its sub-ray
};

/// A way of light from a pixel's surface over bounces.
struct TofPath {
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  ///< its end, just before a surface
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();   ///< of the surface
  double length_m = 0.0;                              ///< from the camera to the end
  double electrons =
      0.0;  ///< of an illuminator that lights the end from 1 m; 0: the path has ended
};

/// Light of a time-of-flight camera. P = number of pixels.
struct TofWorkspace {
  Beams rays;                       ///< of all pixels, at the time of a phase step
  Hits hits;                        ///< of the rays of all pixels
  std::vector<TofLight> light;      ///< P x phase steps of all frequencies
  std::vector<double> reflectance;  ///< P, mean of the rays of the pixel
  std::vector<TofLight>
      bounced_light;           ///< as `light`, over bounces, before the average over pixels
  std::vector<float> bounced;  ///< P, electrons that came over bounces
  std::vector<TofPath> paths;  ///< of a block of pixels
  Beams bounce_rays;           ///< one per path
  Hits bounce_hits;
  Beams illuminator_rays;  ///< one per path
  Hits illuminator_hits;
};

/// Images of a depth camera with a projector. R = number of rays of an image, P = of its pixels.
struct InfraredWorkspace {
  Beams timed_rays;                      ///< of an image while the scene moves
  Hits hits;                             ///< of the rays
  std::vector<float> projector;          ///< R, radiance by the projector's light, W / (m^2 sr)
  std::vector<float> sun;                ///< R, by the sun's; empty: no sun
  std::vector<float> ambient;            ///< R, by all other light
  Beams shadow_rays;                     ///< from a light source
  Hits shadow_hits;                      ///< of these
  std::vector<std::uint8_t> shades;      ///< P
  std::vector<std::uint8_t> edges;       ///< P, whether all rays of the pixel are tested
  std::vector<std::size_t> tested_rays;  ///< of such pixels
  std::vector<std::uint8_t> unseen;      ///< P, surfaces that the second camera does not see
  std::vector<std::uint8_t> unlit;       ///< P, those that the projector does not see
  ElectronRates left;                    ///< of a stereo camera, or the image of the only camera
  ElectronRates right;
  Exposure exposure;
  std::vector<float> projector_px;      ///< R, coordinate of the projector; NaN: not lit
  std::vector<float> pattern_radiance;  ///< R, by the projector's light of a pattern
  std::optional<StereoMatcher> matcher;
};

/// What boxes of objects are found with.
struct BoxWorkspace {
  BoxedClasses classes;  ///< whose objects have boxes; empty: the countable ones
  std::vector<std::optional<Eigen::AlignedBox3d>> mesh_boxes;  ///< per mesh, once it is needed
  Beams nominal;                        ///< one per firing, when pulses have several returns
  Hits nominal_hits;                    ///< of the nominal beams
  MovingCastWorkspace moving;           ///< the beams as the object sees them
  DirectionGrid grid;                   ///< of the beams as the objects see them
  std::vector<std::uint32_t> near;      ///< firings whose beams pass near an object
  std::vector<std::uint8_t> crosses;    ///< per firing: whether its beam may hit this object
  std::vector<std::uint32_t> crossing;  ///< such firings of several objects, one after the other
  std::vector<std::uint32_t> owners;    ///< per firing: the instance for which it is cast
  std::vector<std::uint32_t> owned;     ///< the firings that have an owner, ascending
  std::vector<std::uint8_t> is_object;  ///< per instance: whether beams are cast into it
  std::vector<std::uint8_t> hides;      ///< per instance: whether it hides an owner from its beam
  std::vector<std::uint32_t> hidden;    ///< per instance: beams that hit it behind others
  Beams candidates;                     ///< the beams of the firings with an owner
  Hits hits;                            ///< of the candidates
};

/// Memory that simulations of one sensor in one scene reuse from frame to frame.
struct Workspace {
  Beams fired;  ///< the sensor's beams with their pointing errors
  NoiseWorkspace noise;
  MovingCastWorkspace moving_cast;
  SubRayWorkspace sub_rays;
  InfraredWorkspace infrared;
  TofWorkspace tof;
  BoxWorkspace boxes;
  std::vector<std::uint8_t> visible;  ///< per instance, see Simulation::instance_enabled
};

/// One frame to be simulated: what is measured, with what, and where the result is written.
struct Simulation {
  const Scene& scene;
  const PreparedSensor& prepared;
  Renderer& renderer;
  const Beams& beams;  ///< as the sensor reports them
  const Motion& motion;
  HitColumnMask hit_columns;  ///< ground truth that the frame keeps
  Workspace& workspace;
  Frame& frame;
  ProgressCallback progress;
  const ReturnReplacement& replace_returns;
  /// Per instance: whether the frame's sensor sees it; empty: it sees all.
  std::span<const std::uint8_t> instance_enabled = {};
  bool is_moving = moves_during_frame(motion, beams);
  const Beams* fired = &beams;               ///< the beams with their pointing errors
  std::size_t noise_steps = kMaxNoiseSteps;  ///< how many of them are applied
  WaveformTrace* trace = nullptr;            ///< of a pulse; nullptr: none
};

/// The scene of the frame.
TimedScene timed_scene(const Simulation& s);

/// When exposure `index` of a sequence starts, since the start of the frame, in whole nanoseconds.
std::uint32_t exposure_time_ns(std::size_t index, double interval_s);

/// A cast of beams from the sensor's pose at the frame's start.
CastRequest cast_request(const Simulation& s, const Beams& beams, const HitColumnMask& hit_columns);

/// Casts the request, each beam at its own firing time where something moves.
void cast(const Simulation& s, const CastRequest& request, Hits& hits);

}  // namespace glidar
