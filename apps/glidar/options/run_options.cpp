// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/run_options.hpp>

#include <apps/glidar/options/option_kinds.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace glidar::app {

void add_run_flags(CLI::App& command, RendererOptions& options, const std::string& group) {
  constexpr std::int64_t kMaxThreads = 1024;
  add_choice(
      command,
      {"--renderer", "NAME",
       fmt::format("How beams are cast: {} [{}]", fmt::join(renderer_kinds(), ", "), options.kind),
       group},
      renderer_kinds(), options.kind);
  add_whole(command, {"--threads", "N", "Number of threads, 0: one per processor [0]", group},
            {0, kMaxThreads},
            [&options](std::int64_t n) { options.threads = static_cast<unsigned>(n); });
  constexpr std::int64_t kMaxDevices = 63;
  add_whole(command,
            {"--graphics-device", "N", "Device that opengl draws on [first that can]", group},
            {0, kMaxDevices},
            [&options](std::int64_t n) { options.graphics_device = static_cast<unsigned>(n); });
}

}  // namespace glidar::app
