// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/dds/participant.hpp>

#include <cstdio>
#include <string>
#include <string_view>

namespace glidar::testing {

/// A participant of the domain ROS_DOMAIN_ID, which reports to standard error.
struct Program {
  link::ErrorLog errors{{.log =
                             [](Severity /*severity*/, std::string_view text) {
                               std::fprintf(stderr, "%s\n", std::string(text).c_str());
                             },
                         .progress = {}}};
  dds::Participant participant{{}, errors};
};

/// At once, for the test that waits for it.
inline void print_line(const std::string& text) {
  std::puts(text.c_str());
  std::fflush(stdout);
}

}  // namespace glidar::testing
