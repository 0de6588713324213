// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/help_text.hpp>

#include <glidar/core/text.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>
#include <utility>

namespace glidar::app {
namespace {

/// CLI11's layout without types, and with one empty line between groups.
class HelpLayout final : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override {
    std::string text = CLI::Formatter::make_help(app, std::move(name), mode);
    for (std::size_t at = text.find("\n\n\n"); at != std::string::npos; at = text.find("\n\n\n")) {
      text.erase(at, 1);
    }
    return text;
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    return option->get_type_size() == 0 ? "" : " " + option->get_type_name();
  }
};

}  // namespace

std::string indented(std::string_view words) {
  constexpr std::size_t kWidth = 100;
  std::string text;
  std::string line = " ";
  while (!words.empty()) {
    const std::string_view word = words.substr(0, words.find(' '));
    words.remove_prefix(word.size() == words.size() ? word.size() : word.size() + 1);
    if (line.size() + 1 + word.size() > kWidth) {
      text += line + "\n";
      line = " ";
    }
    line += ' ';
    line += word;
  }
  return text + line + "\n";
}

std::string section_help(const CLI::App& command, const std::string& words) {
  const auto& layout = dynamic_cast<const CLI::Formatter&>(*command.get_formatter());
  std::vector<std::string> headings;
  std::string text;
  for (const CLI::Option* one : command.get_options()) {
    const std::string& heading = one->get_group();
    const auto is_under = [&](const CLI::Option* other) { return other->get_group() == heading; };
    if (heading.empty() || std::ranges::find(headings, heading) != headings.end()) continue;
    headings.push_back(heading);
    if (lower_case(heading).find(lower_case(words)) == std::string::npos) continue;
    text += layout.make_group(heading, false, command.get_options(is_under));
  }
  return text;
}

std::vector<std::string> subcommand_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* one : command.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(one->get_name());
  }
  return names;
}

std::string full_name(const CLI::App& command) {
  const CLI::App* owner = command.get_parent();
  return (owner == nullptr ? "" : full_name(*owner) + " ") + command.get_name();
}

void use_help_layout(CLI::App& program) {
  constexpr std::size_t kNameColumn = 36;
  const auto layout = std::make_shared<HelpLayout>();
  layout->column_width(kNameColumn);
  layout->label("Positionals", "Input");
  program.formatter(layout);
  program.set_help_flag("-h,--help", "Print this help");
}

}  // namespace glidar::app
