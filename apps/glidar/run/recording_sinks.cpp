// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/recording_sinks.hpp>

#include <apps/glidar/options/option_values.hpp>
#include <apps/glidar/run/bag_sink.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/files/overwrite_guard.hpp>
#include <glidar/io/packets/packet_writer.hpp>

#include <set>

namespace glidar::app {
namespace {

/// The packets of one sensor.
class CaptureSink final : public FrameSink {
 public:
  CaptureSink(const std::string& path, const Sensor& sensor) : writer_(path, sensor) {}

  [[nodiscard]] std::vector<std::string> columns(std::size_t /*sensor_index*/) const override {
    return {"xyz", "intensity", "range"};
  }
  void write(const MeasuredFrame& measured) override {
    writer_.write(measured.frame, *measured.beams);
  }
  void finish() override { writer_.finish(); }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override {
    return writer_.files();
  }

 private:
  PacketWriter writer_;
};

std::unique_ptr<FrameSink> make_capture(const std::string& path, const PreparedScene& prepared) {
  if (prepared.sensors.size() != 1) {
    throw Error({path, "a rig of several sensors", "the packets of one sensor",
                 "choose it with --sensor-name"});
  }
  return std::make_unique<CaptureSink>(path, prepared.sensors.front().sensor);
}

/// Throws Error when two recordings have the same name.
void check_names(const std::vector<std::string>& paths) {
  std::set<std::filesystem::path> names;
  for (const std::string& path : paths) {
    if (names.insert(real_path(path)).second) continue;
    throw Error({path, "is given twice as output", "", "choose another name"});
  }
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
      sinks.push_back(is_capture_name(path) ? make_capture(path, prepared)
                                            : make_bag_sink(path, flags, prepared, origin));
    }
  });
  return sinks;
}

}  // namespace glidar::app
