// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glidar::app {

/// How an option stands in --help.
struct OptionText {
  std::string names;  ///< "-w,--width"
  std::string form;   ///< of its value: "PX"
  std::string help;
  std::string group;
};

/// Takes the value of an option; throws Error naming the option when it is no good.
using TakeValue = std::function<void(std::string_view option, const std::string& value)>;

/// Each adds an option whose value is read while the command line is, so that a wrong one is told
/// before any work is done. None takes an empty value.
void add_option(CLI::App& command, const OptionText& text, const TakeValue& take);

/// Any number, also inf and nan; what it may be is checked later.
void add_number(CLI::App& command, const OptionText& text, std::optional<double>& value);

struct WholeRange {
  std::int64_t least;
  std::int64_t most;
};
void add_whole(CLI::App& command, const OptionText& text, const WholeRange& range,
               const std::function<void(std::int64_t)>& take);

void add_choice(CLI::App& command, const OptionText& text, const std::vector<std::string>& choices,
                std::string& value);

/// Text that `check` looks at; none: any text but an empty one.
void add_text(CLI::App& command, const OptionText& text, std::string& value,
              const TakeValue& check = {});

}  // namespace glidar::app
