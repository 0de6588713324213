// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/commands.hpp>
#include <apps/glidar/options/help_text.hpp>
#include <apps/glidar/options/option_values.hpp>
#include <apps/glidar/run/console.hpp>
#include <glidar/core/version.hpp>
#include <glidar/io/config/sensor_presets.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>

namespace glidar::app {
namespace {

constexpr const char* kExamples = R"(Examples:
  glidar completion bash > ~/.local/share/bash-completion/completions/glidar
  glidar completion zsh > ~/.zfunc/_glidar        # a folder of $fpath
  glidar completion fish > ~/.config/fish/completions/glidar.fish
  glidar completion man > ~/.local/share/man/man1/glidar.1

`./dev install` and the packages install all of them.
Exit codes: 0 done, 2 no such shell.)";

std::vector<const CLI::App*> commands_of(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App*) { return true; });
}

/// The subcommands, and after each its tools.
std::vector<const CLI::App*> commands_and_tools(const CLI::App& program) {
  std::vector<const CLI::App*> all;
  for (const CLI::App* command : commands_of(program)) {
    all.push_back(command);
    for (const CLI::App* tool : commands_of(*command)) all.push_back(tool);
  }
  return all;
}

/// The name without that of the program: "render", "depth stereo".
std::string words_of(const CLI::App& command) {
  const std::string name = full_name(command);
  return name.substr(name.find(' ') + 1);
}

/// The options that have a name, not the hidden ones.
std::vector<const CLI::Option*> options_of(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) {
    return !option->get_lnames().empty() && !option->get_group().empty();
  });
}

bool takes_value(const CLI::Option& option) {
  return option.get_expected_max() > 0 && !option.get_type_name().empty();
}

/// The names with their hyphens.
std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

std::string joined(const std::vector<std::string>& words, std::string_view between = " ") {
  return fmt::format("{}", fmt::join(words, between));
}

std::string preset_names() {
  std::vector<std::string> names;
  for (const SensorPreset& preset : sensor_presets()) names.push_back(preset.name);
  return joined(names);
}

std::vector<std::string> all_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options_of(command)) {
    for (const std::string& name : names_of(*option)) names.push_back(name);
  }
  return names;
}

/// The text with a backslash before each of these characters.
std::string escaped(std::string_view text, std::string_view characters) {
  std::string result;
  for (const char c : text) {
    if (characters.find(c) != std::string_view::npos) result += '\\';
    result += c;
  }
  return result;
}

/// For zsh: in quotes, without what ends a description.
std::string zsh_text(std::string_view text) {
  std::string result;
  for (const char c : escaped(text, "[]:")) {
    result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return result;
}

std::string bash_script(const CLI::App& program) {
  std::string tools;
  std::string options;
  for (const CLI::App* command : commands_and_tools(program)) {
    std::string& cases = commands_of(*command).empty() ? options : tools;
    const bool has_options = &cases == &options;
    cases +=
        fmt::format("    '{}') {}='{}' ;;\n", words_of(*command), has_options ? "words" : "tools",
                    joined(has_options ? all_names(*command) : subcommand_names(*command)));
  }
  return fmt::format(R"(# bash completion of glidar {0}
_glidar() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}} words='' tools=''
  local command=${{COMP_WORDS[1]}}
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W '{1} help --help --version' -- "$current"))
    return
  fi
  case $command in
{2}  esac
  if [[ $tools ]]; then
    if ((COMP_CWORD == 2)); then
      COMPREPLY=($(compgen -W "$tools" -- "$current"))
      return
    fi
    command+=" ${{COMP_WORDS[2]}}"
  fi
  case $command in
    help) words='{1}' ;;
{3}  esac
  if [[ $previous == --sensor ]]; then
    COMPREPLY=($(compgen -W '{4}' -- "$current"))
  elif [[ $current == -* || $command == help ]]; then
    COMPREPLY=($(compgen -W "$words" -- "$current"))
  fi
}}
complete -o default -F _glidar glidar
)",
                     version(), joined(subcommand_names(program)), tools, options, preset_names());
}

/// The lines of _arguments for an option.
std::string zsh_option(const CLI::Option& option) {
  const std::string help = zsh_text(option.get_description());
  const std::string value = !takes_value(option)           ? ""
                            : option.check_lname("sensor") ? ":sensor:(" + preset_names() + ")"
                                                           : ":value:_files";
  std::string lines;
  for (const std::string& name : names_of(option)) {
    lines += fmt::format(" \\\n      '*{}[{}]{}'", name, help, value);
  }
  return lines;
}

/// The names with their descriptions, for _describe.
std::string zsh_commands(const CLI::App& owner) {
  std::string words;
  for (const CLI::App* command : commands_of(owner)) {
    words += fmt::format(" '{}:{}'", command->get_name(), zsh_text(command->get_description()));
  }
  return words;
}

std::string zsh_script(const CLI::App& program) {
  std::string tools;
  std::string cases;
  for (const CLI::App* command : commands_and_tools(program)) {
    if (!commands_of(*command).empty()) {
      tools += fmt::format("    {}) tools=({}) ;;\n", words_of(*command), zsh_commands(*command));
      continue;
    }
    cases += fmt::format("    '{}') _arguments -S", words_of(*command));
    for (const CLI::Option* option : options_of(*command)) cases += zsh_option(*option);
    cases += " \\\n      '*:file:_files' ;;\n";
  }
  return fmt::format(R"(#compdef glidar
# zsh completion of glidar {}
_glidar() {{
  local -a commands=({}) tools=()
  if ((CURRENT == 2)); then
    _describe command commands
    return
  fi
  local command=$words[2]
  shift words
  ((CURRENT--))
  case $command in
{}  esac
  if (($#tools)); then
    if ((CURRENT == 2)); then
      _describe tool tools
      return
    fi
    command+=" $words[2]"
    shift words
    ((CURRENT--))
  fi
  case $command in
{}  esac
}}
_glidar "$@"
)",
                     version(), zsh_commands(program), tools, cases);
}

std::string fish_script(const CLI::App& program) {
  std::string text = fmt::format("# fish completion of glidar {}\n", version());
  for (const CLI::App* command : commands_and_tools(program)) {
    const CLI::App& owner = *command->get_parent();
    const std::string condition =
        &owner == &program
            ? "__fish_use_subcommand"
            : fmt::format(
                  "'__fish_seen_subcommand_from {}; and not __fish_seen_subcommand_from {}'",
                  owner.get_name(), joined(subcommand_names(owner)));
    text += fmt::format("complete -c glidar -n {} -f -a {} -d '{}'\n", condition,
                        command->get_name(), escaped(command->get_description(), "'\\"));
    for (const CLI::Option* option : options_of(*command)) {
      text += fmt::format("complete -c glidar -n '__fish_seen_subcommand_from {}'",
                          command->get_name());
      for (const std::string& name : option->get_snames()) text += " -s " + name;
      for (const std::string& name : option->get_lnames()) text += " -l " + name;
      if (takes_value(*option)) text += " -r";
      if (option->check_lname("sensor")) text += " -a '" + preset_names() + "'";
      text += fmt::format(" -d '{}'\n", escaped(option->get_description(), "'\\"));
    }
  }
  return text;
}

/// Text of a manual page: hyphens are minus signs, and no line begins with a control character.
std::string roff(std::string_view text) {
  std::string result;
  bool is_line_start = true;
  for (const char c : text) {
    if (is_line_start && (c == '.' || c == '\'')) result += "\\&";
    if (c == '-' || c == '\\') result += c == '-' ? "\\" : "\\e";
    if (c != '\\') result += c;
    is_line_start = c == '\n';
  }
  return result;
}

std::string manual(const CLI::App& program) {
  std::string text = fmt::format(
      ".TH GLIDAR 1 \"\" \"glidar {}\" \"User Commands\"\n.SH NAME\nglidar \\- {}\n.SH SYNOPSIS\n"
      ".B glidar\nCOMMAND [OPTIONS] ...\n.SH COMMANDS\n",
      version(), roff(program.get_description()));
  for (const CLI::App* command : commands_and_tools(program)) {
    text += fmt::format(".SS \"glidar {}\"\n{}\n", roff(words_of(*command)),
                        roff(command->get_description()));
    for (const CLI::Option* option : options_of(*command)) {
      const std::string value = takes_value(*option) ? " " + option->get_type_name() : "";
      text += fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", roff(joined(names_of(*option), ", ")),
                          roff(value), roff(option->get_description()));
    }
    text += ".PP\n.nf\n" + roff(command->get_footer()) + "\n.fi\n";
  }
  return text;
}

}  // namespace

Command add_completion(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("completion", "Print completions for a shell, or the manual page");
  const auto shell = std::make_shared<std::string>("bash");
  command.footer(kExamples);
  command.add_option("SHELL", *shell, "bash (default), zsh, fish; or man: the manual page");
  return [shell, &program] {
    using Make = std::string (*)(const CLI::App&);
    const auto parse = one_of<Make>(
        {{"bash", bash_script}, {"zsh", zsh_script}, {"fish", fish_script}, {"man", manual}});
    Make make = nullptr;
    with_option_name("SHELL", [&] { make = parse(*shell); });
    print_lines(stdout, make(program));
    return kDone;
  };
}

}  // namespace glidar::app
