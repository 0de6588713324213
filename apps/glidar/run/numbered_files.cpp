// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/numbered_files.hpp>

#include <apps/glidar/run/rig_outputs.hpp>

#include <fmt/format.h>

#include <cstdint>
#include <utility>

namespace glidar::app {

NumberedFiles::NumberedFiles(const StreamFlags& flags, const PreparedScene& prepared,
                             Console& console)
    : flags_(flags), prepared_(prepared), console_(console) {
  first_ = plan(numbered(flags_.render.output, 0), unknown_, unknown_.beams);
}

void NumberedFiles::refuse_overwrite_of_inputs() const {
  app::refuse_overwrite_of_inputs(prepared_.files, first_);
}

void NumberedFiles::begin(std::vector<std::string> reserved) {
  reserved_ = std::move(reserved);
  files_ = outputs_by_sensor(flags_.render, prepared_, console_);
}

HitColumnMask NumberedFiles::hit_columns(std::size_t /*sensor_index*/) const {
  return hit_columns_for_outputs(first_);
}

std::vector<Output> NumberedFiles::plan(const OutputFlags& files, const ActiveSensor& active,
                                        const Beams& beams) const {
  SidecarContext context{.scene = prepared_.scene,
                         .sensor = active.sensor,
                         .beams = beams,
                         .renderer = renderer_name(flags_.render),
                         .inputs = reserved_};
  // otherwise the command does not contain the poses
  if (!has_pose_source(flags_) && flags_.replay.empty()) {
    context.command = flags_.command;
    const std::string label = label_of(flags_.render, active);
    if (!label.empty()) {
      context.command.arguments.insert(context.command.arguments.end(), {"--sensor-name", label});
    }
  }
  return plan_outputs(files, flags_.render.input, context, console_.report());
}

void NumberedFiles::write(const MeasuredFrame& measured) {
  const ActiveSensor& active = prepared_.sensors[measured.sensor_index];
  OutputFlags files = files_[measured.sensor_index];
  if (!has_outputs(files)) return;
  const std::string label = label_of(flags_.render, active);
  if (!label.empty()) files = labelled(files, label);
  const std::vector<Output> outputs =
      plan(numbered(files, static_cast<std::uint32_t>(measured.index)), active, *measured.beams);
  app::refuse_overwrite_of_inputs(reserved_, outputs);
  write_outputs(outputs, measured.frame, *measured.beams, prepared_.scene);
  if (written_ == 0) first_written_ = outputs.front().path;
  last_written_ = outputs.back().path;
  written_ += outputs.size();
}

std::string NumberedFiles::written_text() const {
  if (written_ == 0) return {};
  if (written_ == 1) return " " + first_written_.string();
  return fmt::format(" {} to {} ({} files)", first_written_.string(), last_written_.string(),
                     written_);
}

}  // namespace glidar::app
