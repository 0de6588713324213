// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/tof_image_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/io/files/npy_head.hpp>
#include <glidar/io/formats/npy_file.hpp>
#include <glidar/io/pictures/picture.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace glidar {
namespace {

constexpr const char* kTofRemedy =
    "use a sensor with a depth_camera of type time_of_flight and --depth-model physical, such as "
    "Kinect-v2";

void require_tof(const CloudFile& job, const AtomicFile& file) {
  if (!job.frame.tof_images.level.empty()) return;
  throw Error({file.path().string(), "a frame without raw time-of-flight images",
               "a frame of a time-of-flight camera that is simulated from raw images", kTofRemedy});
}

void write_ir_png(const CloudFile& job, AtomicFile& file) {
  require_tof(job, file);
  constexpr double kMaxLevel = 65535.0;
  std::vector<std::uint16_t> pixels;
  pixels.reserve(job.frame.tof_amplitude.size());
  for (const float amplitude : job.frame.tof_amplitude) {
    const double level = std::floor(static_cast<double>(amplitude) + 0.5);
    pixels.push_back(static_cast<std::uint16_t>(level < kMaxLevel ? level : kMaxLevel));
  }
  write_png({PngKind::grey16, job.frame.cols, job.frame.rows, std::as_bytes(std::span(pixels)),
             job.pixels},
            file);
}

void write_tof_npy(const CloudFile& job, AtomicFile& file) {
  require_tof(job, file);
  const TofImages& images = job.frame.tof_images;
  const std::array<std::size_t, 4> shape = {images.frequencies, images.taps, images.height,
                                            images.width};
  file.write(npy_header("<f4", shape));
  file.write(std::as_bytes(std::span(images.level)));
}

Misfit find_tof_misfit(const CloudPictureOptions& /*picture*/, const Sensor& sensor,
                       const Beams& /*beams*/) {
  const DepthCamera* camera = physical_camera(sensor);
  const bool is_tof = camera != nullptr && std::holds_alternative<TofCamera>(*camera);
  if (is_tof) return {};
  return {"it is not simulated from raw time-of-flight images", kTofRemedy};
}

}  // namespace

Format ir_png_format() {
  return {.info = {.suffix = ".ir.png",
                   .description = "active brightness of a time-of-flight camera",
                   .columns = {}},
          .content = Content::image,
          .write = write_ir_png,
          .pixels = "amplitude, mean of the frequencies, in levels of the raw images",
          .misfit = find_tof_misfit};
}

Format tof_npy_format() {
  return {.info = {.suffix = ".tof.npy",
                   .description = "raw images of a time-of-flight camera",
                   .columns = {}},
          .content = Content::image,
          .write = write_tof_npy,
          .pixels = "raw values, frequencies x phase steps x rows x columns",
          .misfit = find_tof_misfit};
}

TofImages load_tof_images(const std::filesystem::path& path) {
  static const InputFileKind kKind = {"an NPY array of raw images", 1024, ""};
  const std::string bytes = read_input_file(path, kKind);
  const NpyHead head = read_npy_head(path.string(), bytes);
  const std::vector<std::size_t>& shape = head.shape;
  if (shape.size() != 4 || std::find(shape.begin(), shape.end(), 0U) != shape.end()) {
    throw Error({path.string(), "an array of another shape",
                 "frequencies x phase steps x rows x columns", "numpy.reshape the array"});
  }
  require_npy_numbers(path.string(), head, bytes);
  TofImages images{.width = static_cast<std::uint32_t>(shape[3]),
                   .height = static_cast<std::uint32_t>(shape[2]),
                   .frequencies = static_cast<std::uint32_t>(shape[0]),
                   .taps = static_cast<std::uint32_t>(shape[1])};
  images.level.resize(shape[0] * shape[1] * shape[2] * shape[3]);
  const char* at = bytes.data() + head.data_at;
  for (float& level : images.level) {
    level = static_cast<float>(head.number_at(at));
    at += head.number_bytes;
  }
  return images;
}

}  // namespace glidar
