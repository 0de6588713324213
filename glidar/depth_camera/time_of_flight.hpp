// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field.hpp>
#include <glidar/core/raw_images.hpp>
#include <glidar/core/report.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/random.hpp>
#include <glidar/math/thread_pool.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glidar {

class FieldVisitor;

/// Maximum number of modulation frequencies, and of phase steps of each.
inline constexpr std::size_t kMaxTofFrequencies = 8;
inline constexpr std::uint32_t kMaxTofTaps = 16;

/// How whole periods are added to the phases.
enum class TofUnwrapping : std::uint8_t {
  /// All whole numbers of periods of the highest frequency are tried; the phases with the least
  /// misfit win, and the range is the mean of minimum variance, with weights f^2.
  best_fit,
  /// As libfreenect2 does for the Kinect v2 (80, 16 and 120 MHz in this order): one frequency
  /// selects the period of the next; the range is the mean phase over the mean frequency.
  kinect_v2
};

/// The greatest misfit of the unwrapped phases: their distance, in radians, from those of the
/// nearest range. The limit is scale A^exponent, at least min_rad and at most max_rad, with A the
/// greatest amplitude of the frequencies, or the least for an exponent above 0.
struct TofMisfitTest {
  double min_rad = 0.61;
  double max_rad = 0.61;
  double scale = 1.0;
  double exponent = 0.0;
};

/// Smoothing of the complex amplitudes over 3x3 pixels, with the weights of a Gaussian of 3 px
/// times exp(-phase_weight (1 - cos d) / 2), d the difference of the phases (libfreenect2's joint
/// bilateral filter). Neighbours with an amplitude below min_amplitude have no weight. Where the
/// sum of (1 - cos d) / 2 over the neighbours reaches max_phase_change the pixel is at an edge.
struct TofFilter {
  double min_amplitude = 0.0;
  double phase_weight = 7.213475;
  double max_phase_change = 2.5;
};

/// A pixel is at an edge if all of these exceed their limits in its 3x3 pixels: the standard
/// deviation of the amplitude over its mean, the step to the nearest and to the farthest depth, the
/// greater of both, and their mean.
struct TofEdgeTest {
  double amplitude_deviation = 0.0;
  double min_mean_amplitude = 0.0;  ///< the mean counts as at least this
  double near_step_m = 0.05;
  double far_step_m = 0.03;
  double max_step_m = 0.1;
  double mean_step_m = 0.0;
};

/// Options of decode_tof(). Amplitudes have the unit of the raw values times amplitude_gain.
struct TofOptions {
  std::vector<double> frequencies_hz = {};
  std::uint32_t taps = 4;                   ///< N: phase steps of each frequency, 2 pi k / N
  std::vector<double> amplitude_gain = {};  ///< one for each frequency; empty: 1
  /// Raw values of this magnitude or above are saturated; infinity: infinite ones alone.
  double saturation_level = kInfinity;
  TofUnwrapping unwrapping = TofUnwrapping::best_fit;
  double min_amplitude = 0.0;      ///< of every frequency
  double min_amplitude_sum = 0.0;  ///< over all frequencies
  TofMisfitTest misfit_test = {};
  std::optional<TofFilter> filter = {};       ///< empty: none
  std::optional<TofEdgeTest> edge_test = {};  ///< empty: no test
  double near_m = 0.0;                        ///< depth limits
  double far_m = kInfinity;
};

/// Shows every option with its bounds and default to a visitor.
void describe(TofMisfitTest& test, FieldVisitor& visitor);
void describe(TofFilter& filter, FieldVisitor& visitor);
void describe(TofEdgeTest& test, FieldVisitor& visitor);
void describe(TofOptions& options, FieldVisitor& visitor);

/// Throws Error naming the first option that is not allowed.
void validate(const TofOptions& options);

/// The options of libfreenect2 for the Kinect v2: gains, thresholds, filter, tests and limits of
/// DepthPacketProcessor::Parameters (OpenKinect/libfreenect2, src/depth_packet_processor.cpp).
TofOptions kinect_v2_options();

/// The correlation of the received light with the reference, as a function of the phase.
enum class TofWaveform : std::uint8_t {
  sine,     ///< cos(phi)
  triangle  ///< of a square wave with a square wave: 1 at phase 0, -1 at pi
};

/// A continuous-wave camera that is simulated from its raw images. Each of N phase steps of each
/// frequency exposes two wells with (B + A (1 +- m c(phi - 2 pi k / N))) / 2 electrons, where A is
/// the signal, B the background, m the contrast and c the correlation. The decoder gets their
/// difference.
struct TofCamera {
  static constexpr TypeInfo kType = {"time_of_flight",
                                     "raw images of modulated light, decoded to ranges",
                                     "Lange and Seitz, IEEE JQE 37 (2001)"};
  /// A of a phase step from a white diffuse surface at normal incidence at 1 m. It falls with the
  /// square of the range and with the backscatter of the surface.
  double signal_electrons = 0.0;
  double ambient_electrons = 0.0;  ///< B of a phase step from a white surface in the ambient light
  double dark_electrons = 0.0;     ///< B of a phase step without light
  std::vector<double> contrast = {};  ///< m, one for each frequency; empty: 1
  TofWaveform waveform = TofWaveform::sine;
  double read_noise_electrons = 0.0;       ///< standard deviation, of each well
  double full_well_electrons = kInfinity;  ///< from which a well is saturated
  double electrons_per_level = 1.0;        ///< unit of the raw values
  bool has_whole_levels = false;           ///< raw values are rounded
  double step_interval_s = 0.0;            ///< between starts of phase steps; all: at most 4 s
  std::uint32_t sub_rays = 4;              ///< n: each pixel is n x n rays
  std::uint32_t bounces = 1;               ///< diffuse bounces of the light before the surface
  std::uint32_t bounce_rays = 16;          ///< rays per pixel that sample them
  /// Bounced light is averaged over the square of this radius around each pixel; 0: not at all.
  std::uint32_t bounce_filter_px = 3;
  TofOptions decoder = {};
};

/// Keys of `depth_camera` with `type: time_of_flight`.
void describe(TofCamera& camera, FieldVisitor& visitor);

/// Throws Error naming the first value that is not allowed.
void validate(const TofCamera& camera);

/// The correlation of the light with the reference at a phase in turns, from -1 to 1.
double tof_correlation(TofWaveform waveform, double turns);

/// Frequencies and steps of a camera, prepared for many pixels.
struct TofSteps {
  TofWaveform waveform = TofWaveform::sine;
  std::size_t frequencies = 0;
  std::size_t taps = 0;
  std::array<double, kMaxTofFrequencies> per_m = {};  ///< periods per metre of range
  std::array<double, kMaxTofTaps> cosine = {};        ///< of the phase of each step
  std::array<double, kMaxTofTaps> sine = {};
};
TofSteps make_tof_steps(const TofCamera& camera);

/// The light that a pixel receives in one phase step, in electrons: of the illuminator, the same
/// times its correlation, and the background.
struct TofLight {
  double signal = 0.0;
  double correlated = 0.0;
  double background = 0.0;
};

/// Adds light of the illuminator that returns from a range (half of its whole way) to all phase
/// steps of a pixel, frequency by frequency.
void add_light(const TofSteps& steps, double range_m, double electrons,
               std::span<TofLight> of_steps);

/// The same for one phase step, of number frequency x taps + tap.
void add_light(const TofSteps& steps, double range_m, double electrons, std::size_t step,
               TofLight& light);

/// The mean electrons of the two wells.
std::array<double, 2> mean_electrons(const TofCamera& camera, std::size_t frequency,
                                     const TofLight& light);

/// The raw value of a phase step: both wells with shot noise (Poisson) and read noise (normal), and
/// their difference in levels; infinite when a well is full. `key` has the number of the step as
/// its block, and blocks above kMaxTofFrequencies x kMaxTofTaps are used too.
float expose(const TofCamera& camera, std::size_t frequency, const TofLight& light,
             const RngKey& key);

/// The same without noise.
float expose_without_noise(const TofCamera& camera, std::size_t frequency, const TofLight& light);

/// Why a pixel has no range: the first test that it fails, in this order.
enum class TofStatus : std::uint8_t {
  valid,
  not_illuminated,  ///< outside the part of the image that the illuminator lights
  saturated,        ///< a raw value is saturated
  low_signal,       ///< the amplitude is too small, of one frequency or of all
  ambiguous,        ///< the phases fit no range: light of several paths, or noise
  too_near,         ///< depth below the limit
  too_far,          ///< depth above the limit
  edge              ///< neighbours have other phases or depths: light of two surfaces mixes
};
inline constexpr std::size_t kTofStatusCount = 8;

/// "valid", "not_illuminated", "saturated", "low_signal", "ambiguous", "too_near", "too_far" or
/// "edge".
const char* to_string(TofStatus status);

/// What is known about each pixel; an empty span has the value in brackets for all pixels.
struct TofCalibration {
  std::span<const float> depth_per_range = {};        ///< cosine to the boresight (1)
  std::span<const float> phase_offset_rad = {};       ///< frequencies x pixels, subtracted (0)
  std::span<const std::uint8_t> is_illuminated = {};  ///< 0: no light of the illuminator (1)
};

/// The result of decode_tof(), for each pixel, row by row from the top.
struct TofMeasurement {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t frequencies = 0;
  std::vector<double> range_m;    ///< along the pixel's beam; NaN unless the status is valid
  std::vector<TofStatus> status;  ///< as many
  std::vector<float> amplitude;   ///< frequencies x pixels, with amplitude_gain, after the filter
  std::vector<float> phase_rad;   ///< frequencies x pixels, in [0, 2 pi), after the filter
  std::vector<float> misfit_rad;  ///< of the phases; NaN where the signal is low or saturated
};

/// How decode_tof() is executed.
struct TofRun {
  ThreadPool* pool = nullptr;  ///< null: one thread
};

/// Ranges from the raw images of a continuous-wave camera. For each frequency the complex amplitude
/// is (2 / N) sum D_k exp(j 2 pi k / N); its argument is the phase 4 pi f R / c (Lange and Seitz,
/// IEEE J. Quantum Electronics 37 (2001)). Then filter, unwrapping and tests as TofOptions states.
/// The result is the same for every number of threads. Throws Error when the sizes of images,
/// options and calibration differ or an option is not allowed.
TofMeasurement decode_tof(const TofImages& images, const TofOptions& options,
                          const TofCalibration& calibration = {}, const TofRun& run = {});

/// One test of a pixel.
struct TofTest {
  TofStatus failure = TofStatus::valid;  ///< the status of a pixel that fails it
  bool has_passed = true;
  std::string finding;  ///< the numbers that were compared
};

/// A choice of whole periods.
struct TofCandidate {
  double range_m = 0.0;
  double misfit_rad = 0.0;
  std::vector<double> periods = {};  ///< whole periods of each frequency
};

/// How a pixel got its range or status.
struct TofTrace {
  std::uint32_t column = 0;
  std::uint32_t row = 0;
  TofStatus status = TofStatus::valid;
  double range_m = 0.0;  ///< also of pixels that fail a test
  double depth_m = 0.0;
  double misfit_rad = 0.0;
  std::vector<std::vector<double>> levels = {};  ///< frequencies x taps: the raw values
  std::vector<double> frequencies_hz = {};
  std::vector<double> amplitude = {};         ///< of each frequency, after the filter
  std::vector<double> phase_rad = {};         ///< of each frequency, after the filter
  std::vector<TofCandidate> candidates = {};  ///< the least misfit first
  std::vector<TofTest> tests = {};            ///< all of them, in their order
};

/// Decodes the images and reports on one pixel, from the same numbers and tests. Throws Error as
/// decode_tof() does, and when the pixel is outside the image.
TofTrace explain_tof(const TofImages& images, const TofOptions& options,
                     std::array<std::uint32_t, 2> column_row,
                     const TofCalibration& calibration = {}, const TofRun& run = {});

/// The trace as lines of text: result, tests, phases and the best candidates.
std::string format_tof_trace(const TofTrace& trace);

/// Raw images with what is known about their pixels.
struct TofSample {
  TofImages images;
  TofOptions options;
  std::vector<float> depth_per_range;
  std::vector<std::uint8_t> is_illuminated;
};

/// Generated raw images of a Kinect v2 of 160x120 pixels, to try the decoder: a tilted wall, partly
/// beyond the depth limit, a disc before it, a dark and a retroreflecting patch, and corners that
/// the illuminator does not light. Every call returns the same images.
TofSample sample_tof_images();

}  // namespace glidar
