// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>

#include <functional>
#include <string>
#include <vector>

namespace glidar::app {

/// The options of a subcommand under one heading of --help. Values are parsed while the command
/// line is read, so that errors are reported before any work. CLI11's own conversions are not used:
/// they read 010 as 8 and round decimal fractions twice.
class OptionGroup {
 public:
  OptionGroup(CLI::App& command, std::string heading);

  /// Stores a value; throws Error, to which the name of the option is added.
  using StoreValue = std::function<void(const std::string& text)>;
  /// Adds an option ("-w,--width") with a value ("PX"). An empty value is an error.
  void add(const std::string& names, const std::string& value_name, const std::string& help,
           const StoreValue& store) const;
  /// The same; `parse` returns the value of a text or throws Error.
  template <class Value, class Parse>
  void add(const std::string& names, const std::string& value_name, const std::string& help,
           Value& value, const Parse& parse) const {
    add(names, value_name, help, [&value, parse](const std::string& text) { value = parse(text); });
  }
  /// The same for any text.
  void add(const std::string& names, const std::string& value_name, const std::string& help,
           std::string& value) const;
  /// An option whose value may be left out, which then is `value_if_none`.
  void add_optional(const std::string& names, const std::string& value_name,
                    const std::string& help, const std::string& value_if_none,
                    const StoreValue& store) const;
  /// An option that may be repeated, once for each value.
  void add_repeatable(const std::string& names, const std::string& value_name,
                      const std::string& help, const StoreValue& store) const;
  /// An option without a value, which sets `value` to `given`.
  void add_flag(const std::string& names, const std::string& help, bool& value,
                bool given = true) const;

 private:
  CLI::App& command_;
  std::string heading_;
};

using OptionNames = std::vector<std::string>;

/// Refuses command lines with options of both sets.
void forbid_together(CLI::App& command, const OptionNames& first, const OptionNames& second);

/// Refuses command lines with one of these options but without `needed`.
void require_option(CLI::App& command, const OptionNames& options, const std::string& needed);

/// The options under a heading of --help.
OptionNames options_under(const CLI::App& command, const std::string& heading);

}  // namespace glidar::app
