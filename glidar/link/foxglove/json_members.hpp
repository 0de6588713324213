// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

/// Reading of received JSON; every function throws Error for anything but what it returns.
namespace glidar::foxglove {

nlohmann::json parse_object(std::string_view text, const std::string& where);

const nlohmann::json& member(const nlohmann::json& object, const char* name);

/// At most so many bytes.
std::string text_member(const nlohmann::json& object, const char* name, std::size_t max_bytes);

/// A whole number from 0 to `max`.
std::uint64_t whole_number(const nlohmann::json& value, const char* name, std::uint64_t max);

/// One line; invalid UTF-8 is replaced.
std::string compact_text(const nlohmann::json& value);

}  // namespace glidar::foxglove
