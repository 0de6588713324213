// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace glidar::testing {

/// Prints the bytes of the next messages of a topic in hexadecimal, a line each, and "ready"
/// before.
int read_messages(const std::string& topic, const std::string& type, std::size_t count);

/// Prints "matched" once the topic has a reader, then writes each line of its input as a message.
int write_messages(const std::string& topic, const std::string& type);

}  // namespace glidar::testing
