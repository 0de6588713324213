// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/help_text.hpp>

#include <CLI/CLI.hpp>

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

void use_help_layout(CLI::App& program) {
  constexpr std::size_t kNameColumn = 36;
  const auto layout = std::make_shared<HelpLayout>();
  layout->column_width(kNameColumn);
  layout->label("Positionals", "Input");
  program.formatter(layout);
  program.set_help_flag("-h,--help", "Print this help");
}

}  // namespace glidar::app
