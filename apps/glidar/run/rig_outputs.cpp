// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/rig_outputs.hpp>

#include <glidar/core/error.hpp>

#include <fmt/format.h>

namespace glidar::app {
namespace {

[[noreturn]] void refuse_output(const std::string& path, const std::string& reasons,
                                const std::string& remedy) {
  throw Error({.where = "--output, " + path,
               .found = "fits none of the sensors on the rig: " + reasons,
               .allowed = "an output that fits at least one of them",
               .remedy = remedy});
}

/// Adds a path to the outputs of the sensors that it fits.
void distribute(const std::string& path, const OutputFlags& flags, const PreparedScene& prepared,
                std::vector<OutputFlags>& outputs, Console& console) {
  const FileFormat& format = format_of(flags, path);
  std::string reasons;
  std::string remedy;
  std::size_t fitting = 0;
  for (std::size_t i = 0; i < prepared.sensors.size(); ++i) {
    const ActiveSensor& active = prepared.sensors[i];
    const Misfit misfit = find_misfit(format, flags.sink.picture, active.sensor, active.beams);
    if (misfit.reason.empty()) {
      outputs[i].paths.push_back(path);
      ++fitting;
      continue;
    }
    reasons += fmt::format("{}{}: {}", reasons.empty() ? "" : "; ", active.name, misfit.reason);
    remedy = misfit.remedy;
  }
  if (fitting == 0) refuse_output(path, reasons, remedy);
  if (!reasons.empty()) console.info(fmt::format("{} is not written for {}", path, reasons));
}

}  // namespace

std::vector<OutputFlags> outputs_by_sensor(const RenderFlags& flags, const PreparedScene& prepared,
                                           Console& console) {
  std::vector<OutputFlags> outputs(prepared.sensors.size(), flags.output);
  if (prepared.sensors.size() == 1) return outputs;
  for (OutputFlags& output : outputs) output.paths.clear();
  for (const std::string& path : flags.output.paths) {
    distribute(path, flags.output, prepared, outputs, console);
  }
  return outputs;
}

}  // namespace glidar::app
