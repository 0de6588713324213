// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/format.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/pictures/picture.hpp>

#include <fmt/format.h>

#include <span>

namespace glidar {
namespace {

/// Writes the frame's Woods2016Framebuffer byte by byte as 8-bit RGBA; the file's description
/// contains its clipping planes. Throws Error when the frame was not read from such a framebuffer.
void write_woods2016_png(const CloudFile& job, AtomicFile& file) {
  const Woods2016Framebuffer& framebuffer = job.frame.framebuffer;
  if (framebuffer.rgba.empty()) {
    throw Error({file.path().string(), "a frame without a quantized framebuffer",
                 "a frame of --quantized-framebuffer",
                 "render with --renderer opengl --quantized-framebuffer"});
  }
  write_png({PngKind::rgba8, framebuffer.cols, framebuffer.rows,
             std::as_bytes(std::span(framebuffer.rgba)),
             fmt::format("alpha 0: no surface; intensity R / 255; depth n + (256 G + B + 1/2) "
                         "(f - n) / 65536, n = {:.17g} m, f = {:.17g} m",
                         framebuffer.near_m, framebuffer.far_m)},
            file);
}

}  // namespace

Format woods2016_png_format() {
  return {.info = {.suffix = ".framebuffer.png",
                   .description = "8-bit RGBA image of --quantized-framebuffer",
                   .columns = {},
                   .reads_framebuffer = true},
          .content = Content::per_beam,
          .write = write_woods2016_png};
}

}  // namespace glidar
