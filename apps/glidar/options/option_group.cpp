// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/option_group.hpp>

#include <apps/glidar/options/option_values.hpp>

#include <CLI/CLI.hpp>

#include <utility>

namespace glidar::app {
namespace {

/// "--width" of "-w,--width".
std::string long_name(const std::string& names) {
  const std::size_t found = names.find("--");
  return found == std::string::npos ? names : names.substr(found);
}

}  // namespace

OptionGroup::OptionGroup(CLI::App& command, std::string heading)
    : command_(command), heading_(std::move(heading)) {}

void OptionGroup::add(const std::string& names, const std::string& value_name,
                      const std::string& help, const StoreValue& store) const {
  const auto read = [option = long_name(names), value_name, store](const std::string& text) {
    if (text.empty()) throw Error({option, "''", value_name});
    with_option_name(option, [&] { store(text); });
  };
  command_.add_option_function<std::string>(names, read, help)
      ->type_name(value_name)
      ->group(heading_);
}

void OptionGroup::add(const std::string& names, const std::string& value_name,
                      const std::string& help, std::string& value) const {
  add(names, value_name, help, [&value](const std::string& text) { value = text; });
}

void OptionGroup::add_optional(const std::string& names, const std::string& value_name,
                               const std::string& help, const std::string& value_if_none,
                               const StoreValue& store) const {
  const auto read = [option = long_name(names), value_if_none, store](const std::string& text) {
    const bool is_none = text.empty() || text == "true";  // CLI11's words for no value
    with_option_name(option, [&] { store(is_none ? value_if_none : text); });
  };
  command_.add_option_function<std::string>(names, read, help)
      ->expected(0, 1)
      ->type_name(value_name)
      ->group(heading_);
}

void OptionGroup::add_repeatable(const std::string& names, const std::string& value_name,
                                 const std::string& help, const StoreValue& store) const {
  const auto read = [store](const std::vector<std::string>& texts) {
    for (const std::string& text : texts) store(text);
  };
  command_.add_option_function<std::vector<std::string>>(names, read, help)
      ->type_name(value_name)
      ->allow_extra_args(false)
      ->group(heading_);
}

void OptionGroup::add_flag(const std::string& names, const std::string& help, bool& value,
                           bool given) const {
  command_
      .add_flag_callback(
          names, [&value, given] { value = given; }, help)
      ->group(heading_);
}

void forbid_together(CLI::App& command, const OptionNames& first, const OptionNames& second) {
  for (const std::string& name : first) {
    for (const std::string& other : second) {
      command.get_option(name)->excludes(command.get_option(other));
    }
  }
}

void require_option(CLI::App& command, const OptionNames& options, const std::string& needed) {
  for (const std::string& name : options) {
    command.get_option(name)->needs(command.get_option(needed));
  }
}

OptionNames options_under(const CLI::App& command, const std::string& heading) {
  OptionNames names;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group() == heading) names.push_back(option->get_name());
  }
  return names;
}

}  // namespace glidar::app
