// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/commands.hpp>
#include <apps/glidar/options/tof_options.hpp>
#include <apps/glidar/run/exit_code.hpp>
#include <apps/glidar/run/printing.hpp>
#include <apps/glidar/run/sensor_setup.hpp>
#include <apps/glidar/run/status_shares.hpp>
#include <apps/glidar/run/tof_files.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/formats/tof_image_file.hpp>
#include <glidar/simulate/prepared_tof.hpp>
#include <glidar/tof/sample_images.hpp>
#include <glidar/tof/tof_trace.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace glidar::app {
namespace {

constexpr const char* kTofSample = "builtin:disc";

constexpr const char* kTofExamples =
    R"(Decodes the raw images of a continuous-wave camera: for each pixel its range, or the cause of a
hole. RAW is a NumPy array of floats or integers, frequencies x phase steps x rows x columns.
Examples:
  glidar tof builtin:disc -o depth.png -o status.png
  glidar tof builtin:disc --explain 49,56
  glidar render builtin:torus --sensor Kinect-v2 --depth-model physical -o torus.tof.npy
  glidar tof torus.tof.npy --sensor Kinect-v2 -o depth.npy
The sensor is a time-of-flight camera: its frequencies, tests, limits and optics are used.

The end of a name states the content: depth.npy and range.npy float32, m, NaN in holes; depth.png
and range.png 16 bits, --depth-unit-mm; amplitude.npy float32, frequencies x rows x columns;
amplitude.png 16 bits, their mean; status.npy a number and status.png a colour for each cause.
Exit codes: 0 done, 2 the images or options are not valid.)";

void check_tof_flags(const TofFlags& flags) {
  if (flags.outputs.empty() && !flags.explained) {
    throw Error({"--output", "there is neither -o nor --explain, so nothing would be written", "",
                 "add -o depth.png, for example"});
  }
  for (const std::string& path : flags.outputs) (void)tof_quantity(path);
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
  write_tof_files(flags.outputs, input.files,
                  {measured, calibration.depth_per_range, flags.depth_unit_mm * 1e-3});
  if (flags.quiet) return;
  print("{}x{} pixels: {}\nwrote {}\n", measured.width, measured.height,
        status_shares(measured.status, kTofStatusCount),
        fmt::format("{}", fmt::join(flags.outputs, " ")));
}

int run_tof(const TofFlags& flags) {
  check_tof_flags(flags);
  const RawInput input = load_raw(flags);
  const TofSample& raw = input.raw;
  const TofCalibration calibration = {.depth_per_range = raw.depth_per_range,
                                      .is_illuminated = raw.is_illuminated};
  ThreadPool pool(flags.threads);
  std::string trace;  // before any file is written, because the pixel may be outside the image
  if (flags.explained) {
    trace = format_tof_trace(
        explain_tof(raw.images, raw.options, *flags.explained, calibration, {.pool = &pool}));
  }
  if (!flags.outputs.empty()) decode_and_write(flags, input, calibration, pool);
  print_lines(stdout, trace);
  return kDone;
}

}  // namespace

Command add_tof(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("tof", "Decode raw time-of-flight images: range and depth");
  const auto flags = std::make_shared<TofFlags>();
  command.footer(kTofExamples);
  command.add_option("RAW", flags->raw, "Raw images (.npy), or builtin:disc")
      ->required()
      ->type_name("");
  add_tof_options(command, *flags);
  return [flags] { return run_tof(*flags); };
}

}  // namespace glidar::app
