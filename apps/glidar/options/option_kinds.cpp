// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/option_kinds.hpp>

#include <apps/glidar/options/numbers.hpp>
#include <glidar/core/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>

namespace glidar::app {
namespace {

/// "--width" of "-w,--width".
std::string long_name(const std::string& names) {
  const std::size_t found = names.find("--");
  return found == std::string::npos ? names : names.substr(found);
}

[[noreturn]] void refuse_value(std::string_view option, const std::string& value,
                               std::string allowed, std::string remedy = "") {
  throw Error({.where = std::string(option),
               .found = "'" + value + "'",
               .allowed = std::move(allowed),
               .remedy = std::move(remedy)});
}

}  // namespace

void add_option(CLI::App& command, const OptionText& text, const TakeValue& take) {
  const std::string option = long_name(text.names);
  const auto read = [option, form = text.form, take](const std::string& value) {
    if (value.empty()) refuse_value(option, value, form);
    take(option, value);
  };
  command.add_option_function<std::string>(text.names, read, text.help)
      ->type_name(text.form)
      ->group(text.group);
}

void add_number(CLI::App& command, const OptionText& text, std::optional<double>& value) {
  add_option(command, text, [&value](std::string_view option, const std::string& given) {
    value = parse_number(option, given);
  });
}

void add_whole(CLI::App& command, const OptionText& text, const WholeRange& range,
               const std::function<void(std::int64_t)>& take) {
  add_option(command, text, [range, take](std::string_view option, const std::string& given) {
    std::int64_t number = 0;
    const char* end = given.data() + given.size();
    const auto [stop, error] = std::from_chars(given.data(), end, number);
    const bool whole = error == std::errc() && stop == end;
    if (!whole || number < range.least || number > range.most) {
      refuse_value(option, given,
                   fmt::format("a whole number from {} to {}", range.least, range.most));
    }
    take(number);
  });
}

void add_choice(CLI::App& command, const OptionText& text, const std::vector<std::string>& choices,
                std::string& value) {
  add_option(command, text, [choices, &value](std::string_view option, const std::string& given) {
    if (std::find(choices.begin(), choices.end(), given) == choices.end()) {
      constexpr std::size_t kWord = 3;  // shorter ones are near to anything
      const std::string nearest = given.size() < kWord ? "" : closest_match(given, choices);
      refuse_value(option, given, fmt::format("{}", fmt::join(choices, ", ")),
                   nearest.empty() ? "" : fmt::format("did you mean {}?", nearest));
    }
    value = given;
  });
}

void add_text(CLI::App& command, const OptionText& text, std::string& value,
              const TakeValue& check) {
  add_option(command, text, [&value, check](std::string_view option, const std::string& given) {
    if (check) check(option, given);
    value = given;
  });
}

}  // namespace glidar::app
