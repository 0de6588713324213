// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/stream_options.hpp>
#include <apps/glidar/run/frame_sink.hpp>
#include <apps/glidar/run/outputs.hpp>
#include <apps/glidar/run/prepared_scene.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace glidar::app {

/// The files of `-o` for every frame of a stream: NAME_000007.pcd for NAME.pcd.
class NumberedFiles final : public FrameSink {
 public:
  /// Checks the names before the scene is loaded. All must outlive it. Throws Error.
  NumberedFiles(const StreamFlags& flags, const PreparedScene& prepared, Console& console);
  /// Throws Error when one of the first files is an input.
  void refuse_overwrite_of_inputs() const;
  /// Call when the scene is prepared. `reserved`: files that no output may replace.
  void begin(std::vector<std::string> reserved);

  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor_index) const override;
  void write(const MeasuredFrame& measured) override;
  void finish() override {}
  /// " s_000000.pcd to s_000019.pcd (20 files)".
  [[nodiscard]] std::string written_text() const override;

 private:
  [[nodiscard]] std::vector<Output> plan(const OutputFlags& files, const ActiveSensor& active,
                                         const Beams& beams) const;

  const StreamFlags& flags_;
  const PreparedScene& prepared_;
  Console& console_;
  ActiveSensor unknown_;               ///< before the scene is loaded
  std::vector<Output> first_;          ///< of the first frame, to report errors early
  std::vector<std::string> reserved_;  ///< files that no output may replace
  std::vector<OutputFlags> files_;     ///< of each sensor
  std::filesystem::path first_written_;
  std::filesystem::path last_written_;
  std::uint64_t written_ = 0;  ///< files, without sidecars
};

}  // namespace glidar::app
