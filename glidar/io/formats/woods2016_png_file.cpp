// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/woods2016_png_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/pictures/png_image.hpp>

#include <fmt/format.h>

#include <span>

namespace glidar {

void write_paper_png(const CloudFile& job, AtomicFile& file) {
  const Woods2016Framebuffer& picture = job.frame.picture;
  if (picture.rgba.empty()) {
    throw Error({file.path().string(), "a frame that was not read from the paper's framebuffer",
                 "a frame of the paper's target",
                 "render with --renderer opengl --quantized-framebuffer"});
  }
  write_png({PngKind::rgba8, picture.cols, picture.rows, std::as_bytes(std::span(picture.rgba)),
             fmt::format("alpha 0: no surface; intensity R / 255; depth n + (256 G + B + 1/2) "
                         "(f - n) / 65536, n = {:.17g} m, f = {:.17g} m",
                         picture.near_m, picture.far_m)},
            file);
}

}  // namespace glidar
