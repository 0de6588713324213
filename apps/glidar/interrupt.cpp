// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/interrupt.hpp>

#include <glidar/io/atomic_file.hpp>

#include <unistd.h>

#include <csignal>
#include <string_view>

namespace glidar::app {
namespace {

// Only async-signal-safe calls here.
extern "C" void end_now(int /*number*/) {
  constexpr int kExitCode = 130;
  constexpr std::string_view kMessage = "\nglidar: interrupted; unfinished files are removed\n";
  remove_unfinished_files();
  [[maybe_unused]] const ssize_t told = write(STDERR_FILENO, kMessage.data(), kMessage.size());
  _exit(kExitCode);
}

}  // namespace

void end_cleanly_on_interrupt() {
  struct sigaction action {};
  action.sa_handler = end_now;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction before {};
  sigaction(SIGHUP, nullptr, &before);
  if (before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // nohup ignores it
  signal(SIGXFSZ, SIG_IGN);  // write() then fails, and says why
}

}  // namespace glidar::app
