// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/run_options.hpp>

#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace glidar::app {

void add_run_options(CLI::App& command, RendererOptions& options, const std::string& heading) {
  const OptionGroup group(command, heading);
  group.add(
      "--renderer", "NAME",
      fmt::format("How beams are cast: {} [{}]", fmt::join(renderer_kinds(), ", "), options.kind),
      options.kind, one_of(renderer_kinds()));
  add_threads_option(group, options);
  constexpr unsigned kMaxDevice = 63;
  group.add("--graphics-device", "N", "Device for opengl [the first that works]",
            options.graphics_device, whole(0U, kMaxDevice));
}

void add_threads_option(const OptionGroup& group, RendererOptions& options) {
  constexpr unsigned kMaxThreads = 1024;
  group.add("--threads", "N", "Number of threads; 0: one per processor [0]", options.threads,
            whole(0U, kMaxThreads));
}

}  // namespace glidar::app
