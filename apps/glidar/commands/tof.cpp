// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/commands.hpp>
#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>
#include <apps/glidar/run/exit_code.hpp>
#include <apps/glidar/run/image_files.hpp>
#include <apps/glidar/run/printing.hpp>
#include <apps/glidar/run/sensor_setup.hpp>
#include <apps/glidar/run/status_shares.hpp>
#include <glidar/core/error.hpp>
#include <glidar/depth_camera/time_of_flight.hpp>
#include <glidar/io/files/staged_files.hpp>
#include <glidar/io/formats/tof_image_file.hpp>
#include <glidar/simulate/prepared_tof.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace glidar::app {
namespace {

/// What the name of a file asks for.
enum class TofQuantity { depth, range, amplitude, status };

/// "wall_depth.png" is depth. Throws Error for other names.
TofQuantity tof_quantity(const std::string& path) {
  const std::filesystem::path file(path);
  const std::string stem = file.stem().string();
  if (file.extension() == ".png" || file.extension() == ".npy") {
    if (stem.ends_with("depth")) return TofQuantity::depth;
    if (stem.ends_with("range")) return TofQuantity::range;
    if (stem.ends_with("amplitude")) return TofQuantity::amplitude;
    if (stem.ends_with("status")) return TofQuantity::status;
  }
  throw Error({"--output, " + path, "its name does not state what to write",
               "names ending in depth, range, amplitude or status, and .png or .npy",
               "use a name such as depth.png or wall_range.npy"});
}

/// What is written: a result with the cosine of each pixel's direction to the boresight (P; empty:
/// 1), and the unit of PNG images of depth and range.
struct TofResult {
  const TofMeasurement& measured;
  std::span<const float> depth_per_range;
  double unit_m = 0.001;
};

constexpr std::array<Colour, kTofStatusCount> kTofColours = {{{235, 235, 235},
                                                              {110, 110, 110},
                                                              {240, 200, 40},
                                                              {30, 30, 30},
                                                              {230, 120, 30},
                                                              {60, 140, 90},
                                                              {130, 70, 160},
                                                              {40, 90, 200}}};

ImageSize size_of(const TofMeasurement& measured) {
  return {measured.width, measured.height};
}

/// Ranges, or depths along the boresight; NaN where there is none.
std::vector<float> lengths_of(const TofResult& result, bool is_depth) {
  std::vector<float> lengths;
  lengths.reserve(result.measured.range_m.size());
  for (std::size_t i = 0; i < result.measured.range_m.size(); ++i) {
    const bool is_scaled = is_depth && !result.depth_per_range.empty();
    const double cosine = is_scaled ? double{result.depth_per_range[i]} : 1.0;
    lengths.push_back(static_cast<float>(cosine * result.measured.range_m[i]));
  }
  return lengths;
}

void write_lengths(const std::string& path, const TofResult& result, bool is_depth,
                   AtomicFile& file) {
  const std::vector<float> lengths = lengths_of(result, is_depth);
  if (is_npy(path)) {
    return write_image_npy(std::span<const float>(lengths), "<f4", size_of(result.measured), file);
  }
  write_multiples_png(lengths, result.unit_m,
                      std::string(is_depth ? "depth" : "range") + " in units of " +
                          number_text(result.unit_m) + " m, 0: none",
                      size_of(result.measured), file);
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
  write_multiples_png(mean, 1.0, "amplitude, mean of the frequencies, in units of the raw values",
                      size_of(measured), file);
}

void write_quantity(const std::string& path, const TofResult& result, AtomicFile& file) {
  switch (tof_quantity(path)) {
    case TofQuantity::depth:
      return write_lengths(path, result, true, file);
    case TofQuantity::range:
      return write_lengths(path, result, false, file);
    case TofQuantity::amplitude:
      return write_amplitude(path, result.measured, file);
    case TofQuantity::status:
      return write_status_image(path, result.measured.status, kTofColours, size_of(result.measured),
                                file);
  }
}

/// Writes all files, which appear together. `read` are files that must not be overwritten. Throws
/// Error.
void write_tof_files(std::span<const std::string> paths, std::span<const std::string> read,
                     const TofResult& result) {
  StagedFiles files;
  files.protect(read);
  for (const std::string& path : paths) {
    AtomicFile& file = files.add(path);
    write_quantity(path, result, file);
    file.finish();
  }
  files.commit();
}

/// The command line of `glidar tof`.
struct TofFlags {
  std::string raw;
  std::string sensor;  ///< empty: not given
  std::vector<std::string> outputs;
  double depth_unit_mm = 1.0;
  std::optional<std::array<std::uint32_t, 2>> explained;  ///< column and row
  unsigned threads = 0;
  bool quiet = false;
};

/// Declares all options but RAW.
void add_tof_options(CLI::App& command, TofFlags& flags) {
  const OptionGroup camera(command, "Camera");
  camera.add("--sensor", "NAME", "Preset or sensor file of the time-of-flight camera",
             flags.sensor);
  const OptionGroup output(command, "Output");
  output.add_repeatable("-o,--output", "FILE",
                        "Name ending in depth, range, amplitude or status, .npy or .png",
                        [&flags](const std::string& path) { flags.outputs.push_back(path); });
  output.add("--depth-unit-mm", "MM", "Unit of PNG images of depth and range [1]",
             flags.depth_unit_mm, number(kAboveZero, kFinite, "a finite number above 0"));
  output.add("--explain", "X,Y", "Print the phases and tests of a pixel (column, row)",
             flags.explained, parse_pixel);
  const OptionGroup run(command, "Run");
  run.add("-j,--threads", "N", "Number of threads; 0: one per processor [0]", flags.threads,
          whole<unsigned>(0, 4096));
  run.add_flag("-q,--quiet", "No summary, only warnings", flags.quiet);
}

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
