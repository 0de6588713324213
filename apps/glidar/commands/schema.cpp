// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/commands.hpp>
#include <apps/glidar/run/console.hpp>
#include <glidar/io/config/json_schema.hpp>

#include <CLI/CLI.hpp>

#include <memory>

namespace glidar::app {
namespace {

constexpr const char* kSchemaExamples = R"(Examples:
  glidar schema sensor > sensor.schema.json
  glidar schema imu > imu.schema.json
  glidar schema scene > scene.schema.json

Editors with the YAML language server complete and check the keys of a sensor or scene file with
the line
  # yaml-language-server: $schema=sensor.schema.json
The schema of the bundled sensors is beside them, in the folder sensors; that of scenes is in the
folder examples.
Exit codes: 0 done, 2 no such schema.)";

}  // namespace

Command add_schema(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("schema", "Print the JSON Schema of YAML files, for editors");
  const auto name = std::make_shared<std::string>("sensor");
  command.footer(kSchemaExamples);
  command.add_option(
      "KIND", *name,
      "sensor (default), imu, scene, surfaces; pose, motion, materials: parts of scenes");
  return [name] {
    print_lines(stdout, json_schema(*name) + "\n");
    return kDone;
  };
}

}  // namespace glidar::app
