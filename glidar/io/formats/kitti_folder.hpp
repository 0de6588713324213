// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: folders of KITTI's 3D object benchmark (Geiger et al. 2012; formats in the
// readme of its object development kit), which are also sequences of SemanticKITTI (Behley et al.
// 2019).

#include <glidar/io/formats/format.hpp>
#include <glidar/io/formats/kitti_labels.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace glidar {

/// The scan of a frame.
struct KittiScan {
  const CloudFile& velodyne;  ///< a kitti_cloud() in the sensor's frame, without misses
  std::uint32_t number = 0;
  std::span<const KittiCamera> cameras;  ///< one or two
};

/// Six digits, as files of a frame are named.
std::string kitti_number(std::uint32_t number);

/// Adds one scan to a folder: velodyne/NNNNNN.bin, calib/NNNNNN.txt, label_2/NNNNNN.txt, and
/// labels/NNNNNN.label for scenes with classes. Throws Error.
void stage_kitti_scan(const KittiScan& scan, const std::filesystem::path& folder,
                      StagedFiles& files);

/// Adds a whole text file.
void stage_text(const std::filesystem::path& path, const std::string& text, StagedFiles& files);

}  // namespace glidar
