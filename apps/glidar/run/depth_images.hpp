// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/depth_camera/depth_filters.hpp>
#include <glidar/io/files/staged_files.hpp>

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace glidar::app {

/// Depth images to be changed, and where the results are written: a file for one image; for
/// several, or if it is a folder, a folder for files of the same names.
struct DepthImageFiles {
  std::vector<std::string> images;
  std::string settings = {};  ///< a further file that must not be overwritten; empty: none
  std::string output;
  double unit_mm = 1.0;
};

/// What change_depth_images() did.
struct DepthImageSummary {
  std::size_t pixels = 0;  ///< of all images that were read
  std::size_t pixels_with_depth = 0;
  std::size_t written_pixels = 0;  ///< of all images that were written
  std::size_t written_pixels_with_depth = 0;
  std::vector<std::string> files;
};

/// Reads the images in their order, and writes what `change` returns for each, together. Throws
/// Error: no output, an image that is no PNG of 16 bits, two images of one name.
DepthImageSummary change_depth_images(const DepthImageFiles& files,
                                      const std::function<DepthImage(const DepthImage&)>& change);

/// "95.0 % of pixels with depth, 99.1 % after filtering" and the files, in two lines.
std::string summary_text(const DepthImageSummary& summary, const std::string& after);

}  // namespace glidar::app
