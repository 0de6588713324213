// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/tof/tof_camera.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/core/sequence_time.hpp>
#include <glidar/tof/number_checks.hpp>

#include <array>
#include <string>

namespace glidar {
namespace {

constexpr NumberRule kContrastRule = {0.0, 1.0 + 1e-12, true, "a number above 0, up to 1"};
constexpr WholeRule kSubRayRule = {1, 16};
constexpr WholeRule kBounceRule = {0, 32};
constexpr WholeRule kBounceRayRule = {1, 4096};
constexpr WholeRule kFilterRule = {0, 8};

constexpr std::array<Named<TofWaveform>, 2> kWaveformNames = {
    {{"sine", TofWaveform::sine}, {"triangle", TofWaveform::triangle}}};

constexpr const char* kCameraPlace = "time_of_flight, ";

void require_whole_value(const char* key, const WholeRule& rule, std::uint32_t value) {
  if (value >= rule.min && value <= rule.max) return;
  throw Error(
      {kCameraPlace + std::string(key), "is " + std::to_string(value),
       "a whole number from " + std::to_string(rule.min) + " to " + std::to_string(rule.max), ""});
}

void require_contrasts(const TofCamera& camera, const FieldVisitor* visitor) {
  const std::size_t needed = camera.decoder.frequencies_hz.size();
  if (camera.contrast.empty() || camera.contrast.size() == needed) return;
  const std::string found = "has " + std::to_string(camera.contrast.size()) + " numbers for " +
                            std::to_string(needed) + " frequencies";
  if (visitor != nullptr) visitor->reject("contrast", found, "one for each frequency, or none");
  throw Error(
      {kCameraPlace + std::string("contrast"), found, "one for each frequency, or none", ""});
}

void require_sequence(const TofCamera& camera, const FieldVisitor* visitor) {
  const std::size_t steps = camera.decoder.frequencies_hz.size() * camera.decoder.taps;
  const double sequence_s = static_cast<double>(steps) * camera.step_interval_s;
  if (sequence_s <= kMaxSequence_s) return;
  const std::string found = "is " + number_text(camera.step_interval_s) + ", so that " +
                            std::to_string(steps) + " phase steps take " + number_text(sequence_s) +
                            " s";
  const std::string allowed = "at most " + number_text(kMaxSequence_s) + " s for all phase steps";
  const std::string remedy = "use a shorter interval or fewer phase steps";
  if (visitor != nullptr) visitor->reject("step_interval_s", found, allowed, remedy);
  throw Error({kCameraPlace + std::string("step_interval_s"), found, allowed, remedy});
}

}  // namespace

void describe(TofCamera& camera, FieldVisitor& visitor) {
  visitor.number({"signal_electrons", "A of a white diffuse surface at normal incidence at 1 m",
                  kNoUnit, kRequired},
                 kAboveZero, camera.signal_electrons);
  visitor.number({"ambient_electrons", "B of a white surface in the ambient light"}, kFromZero,
                 camera.ambient_electrons);
  visitor.number({"dark_electrons", "B without light"}, kFromZero, camera.dark_electrons);
  visitor.numbers({"contrast", "of the demodulation, one for each frequency", kNoUnit, false, "1"},
                  {.number = kContrastRule,
                   .max_size = kMaxTofFrequencies,
                   .allowed = "a number above 0, up to 1, for each frequency"},
                  camera.contrast);
  visit_choice(visitor,
               {"waveform", "correlation: `sine`, or `triangle` of a square with a square wave"},
               kWaveformNames, camera.waveform);
  visitor.number({"read_noise_electrons", "standard deviation, of each of the two wells"},
                 kFromZero, camera.read_noise_electrons);
  visitor.number({"full_well_electrons", "from which a well is saturated", kNoUnit, false, "none"},
                 kAboveZero, camera.full_well_electrons);
  visitor.number({"electrons_per_level", "unit of the raw values"}, kAboveZero,
                 camera.electrons_per_level);
  visitor.boolean({"has_whole_levels", "raw values are rounded"}, camera.has_whole_levels);
  visitor.number(
      {"step_interval_s",
       "from the start of a phase step to the next; all phase steps take at most 4 s", kUnitSecond},
      kFromZero, camera.step_interval_s);
  visitor.whole_number({"sub_rays", "n: each pixel is n x n rays"}, kSubRayRule, camera.sub_rays);
  visitor.whole_number({"bounces", "diffuse bounces of the light; 0: direct light alone"},
                       kBounceRule, camera.bounces);
  visitor.whole_number({"bounce_rays", "rays per pixel that sample the bounces"}, kBounceRayRule,
                       camera.bounce_rays);
  visitor.whole_number({"bounce_filter_px",
                        "bounced light is averaged over pixels of the same surface in a square of "
                        "this radius; 0: not at all",
                        kUnitPixel},
                       kFilterRule, camera.bounce_filter_px);
  visit_object(visitor, {"decoder", "from raw images to ranges", kNoUnit, kRequired},
               camera.decoder);
  if (!visitor.is_reading()) return;
  require_contrasts(camera, &visitor);
  require_sequence(camera, &visitor);
}

void validate(const TofCamera& camera) {
  tof::require_numbers(kCameraPlace,
                       {{"signal_electrons", kAboveZero, camera.signal_electrons},
                        {"ambient_electrons", kFromZero, camera.ambient_electrons},
                        {"dark_electrons", kFromZero, camera.dark_electrons},
                        {"read_noise_electrons", kFromZero, camera.read_noise_electrons},
                        {"electrons_per_level", kAboveZero, camera.electrons_per_level},
                        {"step_interval_s", kFromZero, camera.step_interval_s}});
  if (camera.full_well_electrons != kInfinity) {
    tof::require_numbers(kCameraPlace,
                         {{"full_well_electrons", kAboveZero, camera.full_well_electrons}});
  }
  for (const double contrast : camera.contrast) {
    tof::require_numbers(kCameraPlace, {{"contrast", kContrastRule, contrast}});
  }
  require_whole_value("sub_rays", kSubRayRule, camera.sub_rays);
  require_whole_value("bounces", kBounceRule, camera.bounces);
  require_whole_value("bounce_rays", kBounceRayRule, camera.bounce_rays);
  require_whole_value("bounce_filter_px", kFilterRule, camera.bounce_filter_px);
  validate(camera.decoder);
  require_contrasts(camera, nullptr);
  require_sequence(camera, nullptr);
}

}  // namespace glidar
