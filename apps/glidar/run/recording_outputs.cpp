// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/recording_outputs.hpp>

#include <apps/glidar/options/option_values.hpp>
#include <apps/glidar/run/bag_output.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/files/overwrite_guard.hpp>
#include <glidar/io/packets/packet_writer.hpp>

#include <set>

namespace glidar::app {
namespace {

/// The packets of one sensor.
class CaptureOutput final : public RecordingOutput {
 public:
  CaptureOutput(const std::string& path, const Sensor& sensor) : writer_(path, sensor) {}

  [[nodiscard]] std::vector<std::string> columns(const ActiveSensor& /*active*/) const override {
    return {"xyz", "intensity", "range"};
  }
  void write(const ActiveSensor& /*active*/, const Frame& frame, const Beams& beams) override {
    writer_.write(frame, beams);
  }
  void finish() override { writer_.finish(); }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override {
    return writer_.files();
  }

 private:
  PacketWriter writer_;
};

std::unique_ptr<RecordingOutput> make_capture(const std::string& path,
                                              const PreparedScene& prepared) {
  if (prepared.sensors.size() != 1) {
    throw Error({path, "a rig of several sensors", "the packets of one sensor",
                 "choose it with --sensor-name"});
  }
  return std::make_unique<CaptureOutput>(path, prepared.sensors.front().sensor);
}

std::unique_ptr<RecordingOutput> make_recording(const std::string& path, const RenderFlags& flags,
                                                const PreparedScene& prepared) {
  refuse_overwrite_of_inputs(prepared.files, path);
  return is_capture_name(path) ? make_capture(path, prepared)
                               : make_bag_output(path, flags, prepared);
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

std::vector<std::unique_ptr<RecordingOutput>> make_recordings(const RenderFlags& flags,
                                                              const PreparedScene& prepared) {
  std::vector<std::unique_ptr<RecordingOutput>> recordings;
  with_option_name("--output", [&] {
    check_names(flags.output.recording_paths);
    for (const std::string& path : flags.output.recording_paths)
      recordings.push_back(make_recording(path, flags, prepared));
  });
  return recordings;
}

}  // namespace glidar::app
