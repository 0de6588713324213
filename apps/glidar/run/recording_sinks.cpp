// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/recording_sinks.hpp>

#include <apps/glidar/options/option_values.hpp>
#include <apps/glidar/run/bag_sink.hpp>
#include <apps/glidar/run/kitti_sink.hpp>
#include <apps/glidar/run/osi_sink.hpp>
#include <apps/glidar/run/packet_sinks.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/files/overwrite_guard.hpp>
#include <glidar/io/formats/kitti_writer.hpp>
#include <glidar/io/osi/osi_trace.hpp>
#include <glidar/io/packets/packet_writer.hpp>

#include <set>

namespace glidar::app {
namespace {

/// Throws Error when two recordings have the same name.
void check_names(const std::vector<std::string>& paths) {
  std::set<std::filesystem::path> names;
  for (const std::string& path : paths) {
    if (names.insert(real_path(path)).second) continue;
    throw Error({path, "is given twice as output", "", "choose another name"});
  }
}

std::unique_ptr<FrameSink> make_recording_sink(const std::string& path, const RenderFlags& flags,
                                               const PreparedScene& prepared,
                                               const std::vector<std::string>& read,
                                               PoseOrigin origin) {
  if (is_kitti_name(path)) return make_kitti_sink(path, flags, prepared, read);
  if (is_capture_name(path)) return make_capture_sink(path, flags, prepared, origin);
  if (osi::is_osi_trace_name(path)) return make_osi_sink(path, prepared, origin);
  return make_bag_sink(path, flags, prepared, origin);
}

}  // namespace

std::vector<std::unique_ptr<FrameSink>> make_recording_sinks(const RenderFlags& flags,
                                                             const PreparedScene& prepared,
                                                             const std::vector<std::string>& read,
                                                             PoseOrigin origin) {
  std::vector<std::unique_ptr<FrameSink>> sinks;
  with_option_name("--output", [&] {
    check_names(flags.output.recording_paths);
    for (const std::string& path : flags.output.recording_paths) {
      refuse_overwrite_of_inputs(read, path);
      sinks.push_back(make_recording_sink(path, flags, prepared, read, origin));
    }
  });
  return sinks;
}

}  // namespace glidar::app
