// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/depth.hpp>
#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/sensor_setup.hpp>
#include <glidar/core/error.hpp>
#include <glidar/depth_camera/time_of_flight.hpp>
#include <glidar/io/formats/tof_image_file.hpp>
#include <glidar/simulate/prepared_tof.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace glidar::app {
namespace {

constexpr std::array<std::string_view, 4> kTofNames = {"depth", "range", "amplitude", "status"};
constexpr ImageContents kTofContents = {kTofNames, kTofNames.size()};

constexpr std::array<Colour, kTofStatusCount> kTofColours = {{{235, 235, 235},
                                                              {110, 110, 110},
                                                              {240, 200, 40},
                                                              {30, 30, 30},
                                                              {230, 120, 30},
                                                              {60, 140, 90},
                                                              {130, 70, 160},
                                                              {40, 90, 200}}};

/// Ranges; with cosines of the pixels, depths along the boresight.
std::vector<float> lengths_of(const TofMeasurement& measured, std::span<const float> cosines = {}) {
  std::vector<float> lengths(measured.range_m.begin(), measured.range_m.end());
  for (std::size_t i = 0; i < cosines.size(); ++i) {
    lengths[i] = static_cast<float>(double{cosines[i]} * measured.range_m[i]);
  }
  return lengths;
}

void write_amplitude(const std::string& path, const TofMeasurement& measured, AtomicFile& file) {
  const std::size_t pixels = measured.status.size();
  if (is_npy(path)) {
    const std::array<std::size_t, 3> shape = {measured.frequencies, measured.height,
                                              measured.width};
    file.write(npy_header("<f4", shape));
    return file.write(std::as_bytes(std::span(measured.amplitude)));
  }
  std::vector<float> mean(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    double sum = 0.0;
    for (std::size_t f = 0; f < measured.frequencies; ++f) {
      sum += double{measured.amplitude[f * pixels + i]};
    }
    mean[i] = static_cast<float>(sum / measured.frequencies);
  }
  write_number_image(path, mean, 1.0,
                     "amplitude, mean of the frequencies, in units of the raw values",
                     {measured.width, measured.height}, file);
}

/// The command line of `glidar depth tof`.
struct TofFlags {
  std::string raw;
  std::string sensor;  ///< empty: not given
  ImageOutputs outputs;
};

/// Declares all options but RAW.
void add_tof_options(CLI::App& command, TofFlags& flags) {
  const OptionGroup camera(command, "Camera");
  camera.add("--sensor", "NAME", "Preset or sensor file of the time-of-flight camera",
             flags.sensor);
  add_output_options(command, kTofContents, flags.outputs);
  add_explain_option(command, "Print the phases and tests of a pixel (column, row)", flags.outputs);
  add_run_options(command, flags.outputs);
}

constexpr const char* kTofSample = "builtin:disc";

constexpr const char* kTofExamples =
    R"(Decodes the raw images of a continuous-wave camera: for each pixel its range, or the cause of a
hole. RAW is a NumPy array of floats or integers, frequencies x phase steps x rows x columns.
Examples:
  glidar depth tof builtin:disc -o depth.png -o status.png
  glidar depth tof builtin:disc --explain 49,56
  glidar render builtin:torus --sensor Kinect-v2 --depth-model physical -o torus.tof.npy
  glidar depth tof torus.tof.npy --sensor Kinect-v2 -o depth.npy
The sensor is a time-of-flight camera: its frequencies, tests, limits and optics are used.

The end of a name states the content: depth.npy and range.npy float32, m, NaN in holes; depth.png
and range.png 16 bits, --depth-unit-mm; amplitude.npy float32, frequencies x rows x columns;
amplitude.png 16 bits, their mean; status.npy a number and status.png a colour for each cause.
Exit codes: 0 done, 2 the images or options are not valid.)";

void check_tof_flags(const TofFlags& flags) {
  check_outputs(flags.outputs, kTofContents, "--explain", flags.outputs.explained.has_value());
  if (flags.raw == kTofSample && !flags.sensor.empty()) {
    throw Error({"--sensor", "builtin:disc has a camera of its own", "", "leave --sensor out"});
  }
  if (flags.raw == kTofSample || !flags.sensor.empty()) return;
  throw Error({"--sensor", "it is missing", "a time-of-flight camera, such as Kinect-v2",
               "add --sensor, or decode builtin:disc"});
}

/// Raw images with the decoder and directions of their sensor, and the files they were read from.
struct RawInput {
  TofSample raw;
  std::vector<std::string> files = {};
};

RawInput load_raw(const TofFlags& flags) {
  if (flags.raw == kTofSample) return {sample_tof_images()};
  const Sensor sensor = load_sensor(flags.sensor, {});
  const auto* camera =
      sensor.depth_camera ? std::get_if<TofCamera>(&*sensor.depth_camera) : nullptr;
  if (camera == nullptr) {
    throw Error({"--sensor", "'" + sensor.name + "' is no time-of-flight camera",
                 "a sensor with a depth_camera of type time_of_flight, such as Kinect-v2",
                 "choose another sensor, or add 'depth_camera' to a sensor file"});
  }
  PreparedTof prepared = prepare_tof(*camera, sensor);
  TofSample raw{load_tof_images(flags.raw), prepared.decoder, std::move(prepared.depth_per_range),
                std::move(prepared.is_illuminated)};
  const PinholeIntrinsics& optics = std::get<Pinhole>(sensor.optics).intrinsics;
  if (raw.images.width == optics.width && raw.images.height == optics.height) {
    std::vector<std::string> files = sensor.files;
    files.push_back(flags.raw);
    return {std::move(raw), std::move(files)};
  }
  throw Error({flags.raw,
               fmt::format("has {}x{} pixels, the sensor '{}' {}x{}", raw.images.width,
                           raw.images.height, sensor.name, optics.width, optics.height),
               "raw images of the sensor", "choose its sensor, or change 'optics' in a copy"});
}

void decode_and_write(const TofFlags& flags, const RawInput& input,
                      const TofCalibration& calibration, ThreadPool& pool) {
  const TofSample& raw = input.raw;
  const TofMeasurement measured = decode_tof(raw.images, raw.options, calibration, {.pool = &pool});
  const ImageSize size = {measured.width, measured.height};
  StagedFiles files;
  files.protect(input.files);
  add_images(
      flags.outputs, kTofContents,
      [&](const std::string& path, std::string_view content, AtomicFile& file) {
        if (content == "amplitude") return write_amplitude(path, measured, file);
        if (content == "status") {
          return write_status_image(path, numbers_of(measured.status), kTofColours, size, file);
        }
        if (content == "range") {
          return write_length_image(path, lengths_of(measured), flags.outputs, "range", size, file);
        }
        write_length_image(path, lengths_of(measured, calibration.depth_per_range), flags.outputs,
                           "depth", size, file);
      },
      files);
  files.commit();
  print_shares(numbers_of(measured.status), status_names<TofStatus>(kTofStatusCount), size,
               flags.outputs);
}

int run_tof(const TofFlags& flags) {
  check_tof_flags(flags);
  const RawInput input = load_raw(flags);
  const TofSample& raw = input.raw;
  const TofCalibration calibration = {.depth_per_range = raw.depth_per_range,
                                      .is_illuminated = raw.is_illuminated};
  ThreadPool pool(flags.outputs.threads);
  std::string trace;  // before any file is written, because the pixel may be outside the image
  if (flags.outputs.explained) {
    trace = format_tof_trace(explain_tof(raw.images, raw.options, *flags.outputs.explained,
                                         calibration, {.pool = &pool}));
  }
  if (!flags.outputs.paths.empty()) decode_and_write(flags, input, calibration, pool);
  print_lines(stdout, trace);
  return kDone;
}

}  // namespace

Command add_tof(CLI::App& depth) {
  CLI::App& command =
      *depth.add_subcommand("tof", "Decode raw time-of-flight images: range and depth");
  const auto flags = std::make_shared<TofFlags>();
  command.footer(kTofExamples);
  command.add_option("RAW", flags->raw, "Raw images (.npy), or builtin:disc")
      ->required()
      ->type_name("");
  add_tof_options(command, *flags);
  return [flags] { return run_tof(*flags); };
}

}  // namespace glidar::app
