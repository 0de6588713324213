// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field.hpp>
#include <glidar/sensor/noise/step_traits.hpp>

namespace glidar {

class FieldVisitor;
struct NoiseBatch;
struct NoiseView;

// Noise models of depth cameras. z is the depth along the boresight. A depth error moves the point
// along its beam, which implies lateral errors of sigma_x = sigma_z x / z.

/// Disparity quantisation: z' = K / (n + offset) with an integer n; K = f b / step, and z^2 / K is
/// the distance between levels.
struct DisparityQuantization {
  static constexpr TypeInfo kType = {"disparity_quantization",
                                     "z = K / (n + offset), n integer; levels are z²/K apart",
                                     "structured light, K = f b / step"};
  static constexpr StepTraits kTraits = {.reads_depth = true};
  double k_m = 0.0;
  double offset_steps = 0.0;
};

/// Kinect v1 and similar cameras: disparity K / z with a normal error, rounded to whole steps.
/// Errors of neighbours are correlated: the error is the mean of white noise over a window x window
/// square, scaled to sigma. 0.44 steps over 9 x 9 pixels fit real frames (0.53 steps in total). K
/// and offset are those of OpenNI's table (PCL, openni_shift_to_depth_conversion.h):
/// 1/z = (1089.4079 - shift) / K.
struct KinectV1 {
  static constexpr TypeInfo kType = {
      "kinect_v1", "normal error of K/z, shared over window x window pixels, then rounded",
      "OpenNI's table; noise of real frames"};
  static constexpr StepTraits kTraits = {.reads_depth = true, .prepares_without_columns = true};
  double k_m = 9.0 / 0.02605;
  double offset_steps = 0.40787;
  double sigma_steps = 0.44;
  unsigned window = 9;  ///< pixels, odd
};

/// Khoshelham and Elberink, "Accuracy and resolution of Kinect depth data", Sensors 12 (2012):
/// sigma_z = 1.425e-3 z^2, half a step of disparity.
struct Khoshelham {
  static constexpr TypeInfo kType = {"khoshelham", "σ_z = 1.425e-3 z²",
                                     "Khoshelham and Elberink, Sensors 12 (2012)"};
  static constexpr StepTraits kTraits = {.reads_depth = true};
  double sigma_per_m = 1.425e-3;
};

/// Nguyen, Izadi, Lovell, "Modeling Kinect sensor noise", 3DIMPVT 2012, axial:
/// sigma_z = 0.0012 + 0.0019 (z - 0.4)^2, and beyond an incidence of 60 degrees also
/// 0.0001 / sqrt(z) theta^2 / (pi/2 - theta)^2. The coefficients differ between cameras.
struct NguyenAxial {
  static constexpr TypeInfo kType = {
      "nguyen_axial", "σ_z = a + b (z - c)², beyond 60° + grazing_coefficient/√z θ²/(π/2 - θ)²",
      "Nguyen, Izadi, Lovell, 3DIMPVT 2012"};
  static constexpr StepTraits kTraits = {.reads_depth = true, .reads_incidence = true};
  double a_m = 0.0012;
  double b_per_m = 0.0019;
  double c_m = 0.4;
  double grazing_coefficient = 0.0001;
};

/// The same paper, lateral: the depth is that at a normal offset of sigma_L pixels along rows and
/// columns, sigma_L = 0.8 + 0.035 theta / (pi/2 - theta).
struct NguyenLateral {
  static constexpr TypeInfo kType = {
      "nguyen_lateral", "depth of the point σ_L x pixels away, σ_L = a + b θ/(π/2 - θ)",
      "Nguyen, Izadi, Lovell, 3DIMPVT 2012"};
  static constexpr StepTraits kTraits = {.reads_depth = true, .reads_incidence = true};
  double a_px = 0.8;
  double b_px = 0.035;
};

/// The method of Barron and Malik (CVPR 2013) and Handa et al. (ICL-NUIM, ICRA 2014): the depth at
/// an offset of N(0, lateral) pixels, disparity K / z plus N(0, sigma), rounded to whole steps.
struct IclKinect {
  static constexpr TypeInfo kType = {
      "icl_kinect", "depth of the point N(0, lateral) away, K/z + N(0, σ), rounded",
      "Barron and Malik 2013; Handa et al. 2014"};
  static constexpr StepTraits kTraits = {.reads_depth = true};
  double k_m = 351.30;
  double lateral_px = 0.5;
  double sigma_steps = 1.0 / 6.0;
};

/// A stereo camera: disparity f b / z with a normal error, optionally rounded to whole steps.
/// sigma_z = z^2 sigma / (f b).
struct Stereo {
  static constexpr TypeInfo kType = {"stereo",
                                     "f b / z + σ x, rounded to steps if set; σ_z = z² σ / (f b)",
                                     "propagation of the disparity error"};
  static constexpr StepTraits kTraits = {.reads_depth = true};
  double focal_px = 0.0;
  double baseline_m = 0.0;
  double sigma_px = 0.0;
  double step_px = 0.0;  ///< 0: not rounded
};

/// The standard deviations of the models above.
double nguyen_axial_sigma_m(const NguyenAxial& model, double z_m, double incidence_rad);
double nguyen_lateral_sigma_px(const NguyenLateral& model, double incidence_rad);

/// Keys in sensor files.
void describe(DisparityQuantization& step, FieldVisitor& visitor);
void describe(KinectV1& step, FieldVisitor& visitor);
void describe(Khoshelham& step, FieldVisitor& visitor);
void describe(NguyenAxial& step, FieldVisitor& visitor);
void describe(NguyenLateral& step, FieldVisitor& visitor);
void describe(IclKinect& step, FieldVisitor& visitor);
void describe(Stereo& step, FieldVisitor& visitor);

void apply(const DisparityQuantization& step, const NoiseView& view, NoiseBatch& batch);
void prepare(const KinectV1& step, const NoiseView& view, NoiseBatch& batch);
void apply(const KinectV1& step, const NoiseView& view, NoiseBatch& batch);
void apply(const Khoshelham& step, const NoiseView& view, NoiseBatch& batch);
void apply(const NguyenAxial& step, const NoiseView& view, NoiseBatch& batch);
void prepare(const NguyenLateral& step, const NoiseView& view, NoiseBatch& batch);
void apply(const NguyenLateral& step, const NoiseView& view, NoiseBatch& batch);
void prepare(const IclKinect& step, const NoiseView& view, NoiseBatch& batch);
void apply(const IclKinect& step, const NoiseView& view, NoiseBatch& batch);
void apply(const Stereo& step, const NoiseView& view, NoiseBatch& batch);

}  // namespace glidar
